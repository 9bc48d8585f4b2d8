// Runs every n-th block on the functional machine.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/survey.h"

#include <algorithm>

#include "exec/endless_loops.h"
#include "exec/executor.h"
#include "pipeline/block_runner.h"

namespace glint::pipeline {

std::vector<BlockWork> run_survey(const exec::World& world, uint64_t instruction_budget, Survey& survey,
                                  exec::FaultLog& passed) {
  std::vector<BlockWork> out;
  if (survey.step == 0) return out;
  exec::Executor executor(world);
  const exec::EndlessLoops endless(*world.image);
  BlockRunner runner(world, endless, instruction_budget);
  for (uint32_t block = survey.first; block < exec::num_blocks(world); block += survey.step) {
    WorkCounts counts;
    try {
      runner.run(executor, block, counts, [] { return false; });
    } catch (const BlockRunner::Failed& failed) {
      throw Error(failed.fault.exit(), executor.passed().with(failed.fault));
    }
    out.push_back({counts.instructions(), counts.rays.nodes});
  }
  const bool has_rays = std::ranges::any_of(out, [](const BlockWork& one) { return one.nodes > 0; });
  for (const BlockWork& one : out) survey.costs.push_back(double(has_rays ? one.nodes : one.instructions));
  passed.add(executor.passed());
  return out;
}

}  // namespace glint::pipeline
