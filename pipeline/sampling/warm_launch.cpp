// Hands the lines of launches to an L2 that nothing else uses.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/warm_launch.h"

#include <utility>

#include "pipeline/sampling/line_touches.h"

namespace glint::pipeline {

mem::MemorySystem& WarmCaches::taken(Caches caches) {
  if (held_ && caches == Caches::Warm) return held_->memory;
  mem::MemoryContents before = held_ ? mem::MemoryContents{} : device_.take_contents();
  held_ = std::make_unique<Unread>(gpu_);
  if (caches == Caches::Warm && !before.empty()) held_->memory.put_contents(std::move(before));
  return held_->memory;
}

RenderResult WarmCaches::run(const exec::World& world, Caches caches, const LaunchWatch& watch) {
  mem::MemorySystem& memory = taken(caches);
  LineTouches touches(
      world, gpu_.memory,
      [&](Address line, uint8_t sectors, mem::Touch touch) { return memory.warm(line, sectors, touch); },
      Written::StaysDirty);
  const FunctionalCounts counts = run_functional_heard(
      world, gpu_.core.instruction_budget, watch,
      {.begin = [&](exec::Executor& executor) { touches.listen_to(executor); }, .nodes = touches.nodes()});
  RenderResult result;
  result.end = counts.end;
  result.progress = counts.progress;
  result.warp_instructions = counts.instructions();
  if (counts.end != LaunchEnd::Whole) held_.reset();
  return result;
}

void WarmCaches::replay(const LaunchTraces& traces, size_t launch, const exec::World& world, Caches caches) {
  traces.replay(launch, *world.memory, taken(caches));
}

void WarmCaches::give_back() {
  if (held_) device_.put_contents(held_->memory.take_contents());
  held_.reset();
}

}  // namespace glint::pipeline
