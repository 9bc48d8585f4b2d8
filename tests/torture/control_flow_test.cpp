// Runs random structured programs, lane by lane against the interpreter.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <exception>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <random>

#include "frontend/compile.h"
#include "frontend/spirv/spirv.h"
#include "tests/support/catch.h"
#include "tests/torture/machines.h"
#include "tests/torture/settings.h"
#include "tests/torture/tree.h"

namespace glint::test::torture {
namespace {

std::vector<uint32_t> compile_glsl(const std::string& text, bool is_compute) {
  static const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("glint_torture_{}", std::random_device()());
  std::filesystem::create_directories(folder);
  const std::filesystem::path file = folder / (is_compute ? "program.comp" : "program.rgen");
  std::ofstream(file) << text;
  auto words = frontend::glsl_to_spirv(file.string(), {});
  std::filesystem::remove_all(folder);
  return words;
}

Trial trial_of(const ProgramTree& program) {
  Trial trial;
  trial.name = fmt::format("seed {}", program.seed);
  trial.spirv = program.spirv ? to_spirv(program) : compile_glsl(to_glsl(program), program.is_compute);
  const uint32_t lanes = program.group * program.groups;
  trial.launch.threads = {lanes, 1, 1};
  trial.launch.steps_a_lane = 30'000;
  Random random(program.seed ^ 0x5eed);
  auto& inputs = trial.launch.buffers[kInputBinding];
  for (uint32_t i = 0; i < kInputWords; ++i)
    inputs.push_back(random.chance(60) ? random.below(16) : uint32_t(random.bits()));
  trial.launch.buffers[kResultBinding].assign(lanes, 0xdead'0000);
  auto& own = trial.launch.buffers[kOwnBinding];
  for (uint32_t i = 0; i < lanes * kOwnWords; ++i) own.push_back(uint32_t(random.bits()) & 0xff);
  return trial;
}

std::vector<Way> ways_of(const ProgramTree& program) {
  static const std::vector<Way> kRotating = {
      {16, true, false, true}, {16, false, false, true}, {255, true, false, true}, {64, false, false, true},
      {64, true, true, true},  {16, true, true, true},   {24, true, false, true},  {20, false, false, true}};
  std::vector<Way> ways{{64, true, false, true}, kRotating[program.seed % kRotating.size()]};
  if (program.spirv && program.functions.size() == 1) {
    ways.push_back({64, true, false, false});
    Way raw = kRotating[(program.seed / 3) % kRotating.size()];
    raw.simplified = false;
    ways.push_back(raw);
  }
  return ways;
}

Verdict judge_program(const ProgramTree& program) {
  try {
    Trial trial = trial_of(program);
    if (program.spirv && !frontend::validate_spirv(trial.spirv).empty()) return {{}, true, 0, false};
    return judge(trial, ways_of(program));
  } catch (const std::exception& error) {
    return {error.what(), false, 0, false};
  }
}

// Drops statements, or puts a body in place of its construct, as long as the same kind of problem stays.
class Minimiser {
 public:
  explicit Minimiser(ProgramTree program) : best_(std::move(program)) {}
  ProgramTree run() {
    const std::string kind = kind_of(judge_program(best_).problem);
    for (bool progress = true; progress && tries_ > 0;) {
      progress = false;
      for (size_t f = 0; f < best_.functions.size(); ++f)
        for (size_t n = 0; tries_ > 0; ++n) {
          bool any = false;
          for (bool unwrap : {false, true}) {
            ProgramTree next = best_;
            size_t at = n;
            if (!remove(next.functions[f].body, at, unwrap)) break;
            any = true;
            --tries_;
            if (kind_of(judge_program(next).problem) != kind) continue;
            best_ = std::move(next);
            progress = true;
            break;
          }
          if (!any) break;
        }
    }
    return best_;
  }

 private:
  // Returns the kind of a problem. All differences are alike; other problems differ by their first words.
  static std::string kind_of(const std::string& problem) {
    if (problem.find("expected 0x") != std::string::npos) return "difference";
    return problem.substr(0, 12) +
           problem.substr(std::min(problem.size(), problem.find("machine, ") + 9)).substr(0, 60);
  }
  // Removes statement number `at` in the order of reading.
  static bool remove(std::vector<Stmt>& list, size_t& at, bool unwrap) {
    for (size_t i = 0; i < list.size(); ++i) {
      if (at == 0) {
        const Stmt gone = list[i];
        list.erase(list.begin() + long(i));
        if (unwrap && gone.bodies.empty()) return false;
        if (unwrap) list.insert(list.begin() + long(i), gone.bodies[0].begin(), gone.bodies[0].end());
        return true;
      }
      --at;
      for (auto& body : list[i].bodies)
        if (remove(body, at, unwrap)) return true;
    }
    return false;
  }
  ProgramTree best_;
  int tries_ = 400;
};

void torture(bool spirv, uint64_t default_first, uint64_t default_count) {
  const uint64_t first = setting("GLINT_TORTURE_SEED", default_first),
                 count = setting("GLINT_TORTURE_COUNT", default_count);
  const uint64_t most_failures = setting("GLINT_TORTURE_FAILURES", 1);
  uint64_t skipped = 0, failures = 0, statements = 0, divergent = 0;
  for (uint64_t seed = first; seed < first + count && failures < most_failures; ++seed) {
    const ProgramTree program = generate(seed, spirv);
    statements += count_statements(program);
    const Verdict verdict = judge_program(program);
    skipped += verdict.skipped;
    divergent += verdict.lanes_differ;
    if (verdict.problem.empty()) continue;
    ++failures;
    UNSCOPED_INFO("GLINT_TORTURE_SEED=" << seed << " GLINT_TORTURE_COUNT=1: " << verdict.problem);
    const ProgramTree small = Minimiser(program).run();
    std::string text;
    try {
      text = spirv ? frontend::disassemble_spirv(to_spirv(small)) : to_glsl(small);
    } catch (const std::exception& error) {
      text = error.what();
    }
    UNSCOPED_INFO("smallest: " << judge_program(small).problem << "\n" << text);
    CHECK(verdict.problem.empty());
  }
  CHECK(failures == 0);
  CHECK((count < 100 || skipped * 10 <= count));  // otherwise little was compared
  INFO(statements << " statements");
  CHECK(statements >= count * 5);
  CHECK((count < 100 || divergent * 10 >= count * 5));  // otherwise one lane would have been enough
}

TEST_CASE("Random GLSL programs compute in every lane what the interpreter computes") {
  torture(false, 1, 300);
}

TEST_CASE("Random SPIR-V control flow computes in every lane what the interpreter computes") {
  torture(true, 1, 500);
}

// One arm of this selection leaves for the continue target, which nothing else reaches.
TEST_CASE("SPIR-V programs that once found mistakes compute what the interpreter computes") {
  torture(true, 2356, 1);
}

}  // namespace
}  // namespace glint::test::torture
