// Runs the blocks of a launch in order, or on several threads where that makes no difference.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/functional_machine.h"

#include <algorithm>
#include <memory>

#include "base/host_threads.h"
#include "isa/effects.h"
#include "pipeline/blocks_ahead.h"

namespace glint::pipeline {
namespace {

FunctionalCounts run_in_order(const exec::World& world, uint64_t instruction_budget, const LaunchWatch& watch,
                              const LaunchListener& listener, core::LaunchCosts* costs) {
  exec::Executor executor(world);
  const exec::EndlessLoops endless(*world.image);
  BlockRunner runner(world, endless, instruction_budget);
  std::unique_ptr<core::CostRecorder> recorder;
  if (listener.begin) listener.begin(executor);
  if (costs) {
    recorder = std::make_unique<core::CostRecorder>(*costs, executor.warps_per_block());
    executor.called.listen([&recorder](const exec::Called& called) {
      recorder->call(called.warp.warp_in_block, called.stage, called.lanes);
    });
  }
  FunctionalCounts counts;
  uint32_t index = 0;
  const auto tell = [&] {
    counts.progress.ended_warps = uint64_t{index} * executor.warps_per_block();
    if (!watch.progress) return;
    counts.progress.instructions = counts.instructions();
    watch.progress(counts.progress, [&runner] {
      const auto line = runner.busiest_line();
      return line ? line->place : "";
    });
  };
  const auto is_over = [&] {
    tell();
    return watch.stop && watch.stop();
  };
  counts.progress.num_warps = executor.num_warps();
  try {
    for (; index < executor.num_blocks(); ++index)
      if (!runner.run(executor, index, counts, is_over, recorder.get(), listener.nodes)) {
        counts.end = LaunchEnd::Stopped;
        counts.progress.instructions = counts.instructions();
        if (const auto line = runner.busiest_line()) counts.progress.where = line->to_string(*world.image);
        break;
      }
  } catch (const BlockRunner::Failed& failed) {
    throw Error(failed.fault.exit(), executor.passed().with(failed.fault));
  }
  if (counts.end == LaunchEnd::Whole) tell();
  counts.faults = executor.passed();
  counts.not_finite = executor.not_finite_stores();
  return counts;
}

// What shaders print comes in order of launch ids, and as each thread printed it.
bool prints(const exec::World& world) {
  return world.prints && std::ranges::any_of(world.image->code, [](const exec::Step& step) {
           return isa::effect_row(step.effect).family == isa::EffectFamily::Print;
         });
}

}  // namespace

FunctionalCounts run_functional(const exec::World& world, uint64_t instruction_budget,
                                const LaunchWatch& watch, const Probe<exec::Retired>::Listener& listener,
                                core::LaunchCosts* costs, uint32_t threads) {
  const uint32_t wanted = std::min(host_threads(threads), exec::num_blocks(world));
  if (wanted < 2 || listener || costs || prints(world))
    return run_in_order(world, instruction_budget, watch,
                        {.begin =
                             [&](exec::Executor& executor) {
                               if (listener) executor.retired.listen(listener);
                             },
                         .nodes = {}},
                        costs);
  return run_ahead(world, instruction_budget, watch, wanted);
}

FunctionalCounts run_functional_heard(const exec::World& world, uint64_t instruction_budget,
                                      const LaunchWatch& watch, const LaunchListener& listener) {
  return run_in_order(world, instruction_budget, watch, listener, nullptr);
}

}  // namespace glint::pipeline
