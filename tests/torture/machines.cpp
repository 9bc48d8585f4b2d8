// Runs one compute or ray-generation shader in a small world whose buffers are words.
// SPDX-License-Identifier: Apache-2.0
#include "tests/torture/machines.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <fmt/format.h>
#include <stdexcept>

#include "exec/image.h"
#include "frontend/compile.h"
#include "isa/verify.h"
#include "pipeline/functional_machine.h"
#include "pipeline/timing_machine.h"
#include "tests/torture/tree.h"

namespace glint::test::torture {
namespace {

constexpr uint64_t kBudget = 4'000'000;  // instructions per warp

isa::Program compile(Trial& trial, const Way& way) {
  Diagnostics diagnostics;
  if (way.simplified && trial.simplified.empty())
    trial.simplified = frontend::simplify(trial.spirv, trial.name, diagnostics);
  const auto& words = way.simplified ? trial.simplified : trial.spirv;
  isa::Program program = frontend::lower(words, trial.name, {way.max_registers, way.schedule});
  isa::verify(program, diagnostics);
  diagnostics.throw_if_errors();  // a warning: the optimiser failed, and the module was lowered as it was
  return program;
}

}  // namespace

std::string Way::to_string() const {
  return fmt::format("{} registers, {}, {} machine, {}", max_registers, schedule ? "scheduled" : "in order",
                     timing ? "timing" : "functional", simplified ? "simplified" : "lowered as written");
}

std::map<uint32_t, std::vector<uint32_t>> run_machine(Trial& trial, const Way& way) {
  const isa::Program program = compile(trial, way);
  exec::World world;
  mem::AddressSpace memory;
  world.memory = &memory;
  world.constant_bank.resize(isa::kConstantBankBytes);
  const exec::Image image = exec::link({program});
  world.image = &image;
  world.raygen = 0;
  world.local_bytes = (program.local_bytes + 15) / 16 * 16;
  world.launch_size = trial.launch.threads;
  if (program.stage == isa::Stage::Compute) {
    const auto& block = program.local_size;
    std::array<uint32_t, 3> grid;
    for (size_t axis = 0; axis < 3; ++axis) grid[axis] = trial.launch.threads[axis] / block[axis];
    exec::set_blocks(world, grid, block, program.shared_bytes);
  }
  exec::place_plain_table(world, memory.allocate("binding table", exec::plain_table_bytes(world)));
  std::map<uint32_t, Address> places;
  for (const auto& [binding, words] : trial.launch.buffers) {
    const Address at = memory.allocate(fmt::format("binding {}", binding), words.size() * 4);
    memory.write(at, words.data(), words.size() * 4);
    const uint64_t descriptor[2] = {at, words.size() * 4};
    std::memcpy(world.constant_bank.data() + binding * isa::kDescriptorBytes, descriptor, sizeof(descriptor));
    places[binding] = at;
  }
  if (way.timing) {
    pipeline::GpuParams gpu;
    gpu.cores = 2;
    gpu.core.instruction_budget = kBudget;
    pipeline::TimingMachine(gpu, world, false).run({});
  } else {
    pipeline::run_functional(world, kBudget, {});
  }
  std::map<uint32_t, std::vector<uint32_t>> after;
  for (const auto& [binding, at] : places) {
    const auto words = memory.view<uint32_t>(at, trial.launch.buffers.at(binding).size());
    after[binding].assign(words.begin(), words.end());
  }
  return after;
}

std::string difference(Trial& trial, const ScalarLaunch& expected, const Way& way) {
  std::map<uint32_t, std::vector<uint32_t>> after;
  try {
    after = run_machine(trial, way);
  } catch (const std::exception& error) {
    return fmt::format("{}: {}", way.to_string(), error.what());
  }
  for (const auto& [binding, words] : expected.buffers)
    for (size_t i = 0; i < words.size(); ++i)
      if (words[i] != after.at(binding)[i])
        return fmt::format("{}: binding {} word {} (lane {} if results): {:#010x}, expected {:#010x}",
                           way.to_string(), binding, i, i / trial.words_a_lane, after.at(binding)[i],
                           words[i]);
  return {};
}

Verdict judge(Trial& trial, const std::vector<Way>& ways) {
  Verdict verdict;
  ScalarLaunch expected = trial.launch;
  try {
    verdict.steps = Interpreter(trial.spirv).run(expected);
  } catch (const std::exception& error) {
    verdict.skipped = std::string(error.what()).find("more steps") != std::string::npos;
    if (!verdict.skipped) verdict.problem = error.what();
    return verdict;
  }
  const auto& results = expected.buffers.at(kResultBinding);
  verdict.lanes_differ =
      std::any_of(results.begin(), results.end(), [&](uint32_t x) { return x != results[0]; });
  for (const Way& way : ways) {
    verdict.problem = difference(trial, expected, way);
    if (verdict.problem.empty()) continue;
    // The optimiser's inlining into a continue target may make an invalid module. The frontend then refuses
    // the calls.
    if (verdict.problem.find("OpFunctionCall") != std::string::npos) return {{}, true, verdict.steps, false};
    if (!way.simplified) return verdict;
    ScalarLaunch again = trial.launch;  // this tells whose mistake it is
    try {
      Interpreter(trial.simplified).run(again);
      verdict.problem +=
          again.buffers == expected.buffers
              ? "\n(the interpreter agrees with itself on the simplified module)"
              : "\n(the interpreter differs on the simplified module: the optimiser's mistake)";
    } catch (const std::exception& error) {
      verdict.problem += fmt::format("\n(on the simplified module: {})", error.what());
    }
    return verdict;
  }
  return verdict;
}

}  // namespace glint::test::torture
