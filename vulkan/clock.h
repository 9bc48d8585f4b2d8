// Counts the time of a device in core cycles. Timestamps read it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "base/types.h"
#include "memsys/peak.h"
#include "pipeline/params.h"

namespace glint::vulkan {

// Model: commands run one after another. A launch that was not timed takes as long as its instructions need
// at least on cores whose schedulers all issue in every cycle; a transfer takes its bytes over the memory's
// peak.
class DeviceClock {
 public:
  explicit DeviceClock(const pipeline::GpuParams& gpu)
      : issue_width_(double(gpu.cores) * gpu.core.schedulers),
        bytes_per_cycle_(mem::peak(gpu.memory, gpu.cores, gpu.clock_mhz).dram_bandwidth /
                         (gpu.clock_mhz * 1e6)) {}

  Cycle now() const { return Cycle(now_); }
  void add_launch(uint64_t warp_instructions) { now_ += double(warp_instructions) / issue_width_ + 1; }
  void add_timed_launch(Cycle cycles) { now_ += double(cycles); }
  void add_transfer(uint64_t bytes) { now_ += double(bytes) / bytes_per_cycle_ + 1; }

 private:
  double issue_width_, bytes_per_cycle_, now_ = 0;
};

}  // namespace glint::vulkan
