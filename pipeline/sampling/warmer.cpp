// Runs blocks one by one, and hands on their lines.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/warmer.h"

#include <utility>

namespace glint::pipeline {

Warmer::Warmer(const exec::World& world, uint64_t instruction_budget, const mem::Params& params,
               LineTouches::Sink sink, Written written)
    : touches_(world, params, std::move(sink), written),
      executor_(world),
      endless_(*world.image),
      runner_(world, endless_, instruction_budget) {
  touches_.listen_to(executor_);
}

WorkCounts Warmer::run(uint32_t index) {
  WorkCounts counts;
  try {
    runner_.run(
        executor_, index, counts, [] { return false; }, nullptr, touches_.nodes());
  } catch (const BlockRunner::Failed& failed) {
    throw Error(failed.fault.exit(), executor_.passed().with(failed.fault));
  }
  return counts;
}

}  // namespace glint::pipeline
