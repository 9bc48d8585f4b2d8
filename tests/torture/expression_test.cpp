// Runs random expressions over all exact ops, bit by bit against the interpreter.
// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <fmt/format.h>

#include "tests/support/catch.h"
#include "tests/torture/expressions.h"
#include "tests/torture/machines.h"
#include "tests/torture/settings.h"
#include "tests/torture/tree.h"

namespace glint::test::torture {
namespace {

// Names the first value that differs in any lane, and its operands.
std::string name_difference(const ExpressionProgram& program, const std::vector<uint32_t>& got,
                            const std::vector<uint32_t>& expected) {
  const size_t a_lane = program.values.size() * kValueWords;
  for (size_t v = 0; v < program.values.size(); ++v)
    for (size_t lane = 0; lane < program.lanes; ++lane)
      for (size_t word = 0; word < kValueWords; ++word) {
        const size_t at = lane * a_lane + v * kValueWords + word;
        if (got[at] == expected[at]) continue;
        std::string text =
            fmt::format("lane {}: {}: word {} is {:#010x}, expected {:#010x}\nvalues of the lane:", lane,
                        program.values[v], word, got[at], expected[at]);
        for (size_t before = 0; before < v; ++before)
          if (program.values[v].find(fmt::format("v{},", before)) != std::string::npos ||
              program.values[v].find(fmt::format("v{})", before)) != std::string::npos ||
              program.values[v].find(fmt::format("v{} ", before)) != std::string::npos) {
            text += fmt::format("\n  v{}:", before);
            for (size_t i = 0; i < kValueWords; ++i)
              text += fmt::format(" {:#x}", expected[lane * a_lane + before * kValueWords + i]);
          }
        return text;
      }
  return {};
}

TEST_CASE("Random expressions over all exact ops give the interpreter's bits in every lane") {
  const uint64_t first = setting("GLINT_TORTURE_SEED", 1), count = setting("GLINT_TORTURE_COUNT", 120),
                 most_failures = setting("GLINT_TORTURE_FAILURES", 1);
  static const std::vector<Way> kWays = {{64, true, false, true},
                                         {64, true, false, false},
                                         {16, true, false, true},
                                         {255, false, false, false},
                                         {64, true, true, true}};
  uint64_t failures = 0;
  for (uint64_t seed = first; seed < first + count && failures < most_failures; ++seed) {
    const ExpressionProgram program = random_expressions(seed, 40);
    Trial trial;
    trial.name = fmt::format("seed {}", seed);
    trial.spirv = program.spirv;
    trial.words_a_lane = uint32_t(program.values.size()) * kValueWords;
    trial.launch.threads = {program.lanes, 1, 1};
    trial.launch.buffers[kInputBinding] = expression_inputs(seed);
    trial.launch.buffers[kResultBinding].assign(size_t{program.lanes} * trial.words_a_lane, 0);
    ScalarLaunch expected = trial.launch;
    Interpreter(trial.spirv).run(expected);
    const Way& way = kWays[seed % kWays.size()];
    std::string problem;
    try {
      const auto after = run_machine(trial, way);
      problem = name_difference(program, after.at(kResultBinding), expected.buffers.at(kResultBinding));
    } catch (const std::exception& error) {
      problem = error.what();
    }
    if (problem.empty()) continue;
    ++failures;
    UNSCOPED_INFO("GLINT_TORTURE_SEED=" << seed << " GLINT_TORTURE_COUNT=1: " << way.to_string() << ": "
                                        << problem);
    CHECK(problem.empty());
  }
  CHECK(failures == 0);
}

}  // namespace
}  // namespace glint::test::torture
