// Runs the blocks of a launch in order, and hands their lines to an L2 that nothing else uses.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/warm_launch.h"

#include <utility>

#include "exec/launch.h"
#include "memsys/memory_system.h"
#include "pipeline/sampling/warmer.h"

namespace glint::pipeline {

RenderResult warm_launch(const exec::World& world, const GpuParams& gpu, Caches caches, Device& device,
                         const LaunchWatch& watch) {
  RenderResult result;
  stats::Group unread(nullptr, "gpu");
  mem::MemorySystem memory(gpu.memory, gpu.cores, gpu.clock_mhz, &unread);
  mem::MemoryContents before = device.take_contents();
  if (caches == Caches::Warm && !before.empty()) memory.put_contents(std::move(before));
  const auto sink = [&](Address line, uint8_t sectors, mem::Touch touch) {
    return memory.warm(line, sectors, touch);
  };
  Warmer warmer(world, gpu.core.instruction_budget, gpu.memory, sink, Written::StaysDirty);
  const uint32_t num_blocks = exec::num_blocks(world);
  LaunchProgress progress;
  progress.num_warps = uint64_t{num_blocks} * exec::warps_per_block(world);
  for (uint32_t block = 0; block < num_blocks; ++block) {
    if (watch.stop && watch.stop()) {
      result.end = LaunchEnd::Stopped;
      result.progress = progress;
      return result;
    }
    const WorkCounts counts = warmer.run(block);
    result.warp_instructions += counts.instructions();
    progress.instructions += counts.instructions();
    progress.ended_warps += exec::warps_per_block(world);
    if (watch.progress) watch.progress(progress, [] { return ""; });
  }
  device.put_contents(memory.take_contents());
  return result;
}

}  // namespace glint::pipeline
