// Counts the time of a device in core cycles. Timestamps read it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <utility>

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

  // Are the transfers since they were asked for last.
  struct Transfers {
    Cycle begin = 0, end = 0;
    uint64_t count = 0, bytes = 0;
  };
  Transfers take_transfers() { return std::exchange(transfers_, {}); }

  Cycle now() const { return Cycle(now_); }
  void add_launch(uint64_t warp_instructions) { now_ += double(warp_instructions) / issue_width_ + 1; }
  void add_timed_launch(Cycle cycles) { now_ += double(cycles); }
  void add_transfer(uint64_t bytes) {
    if (transfers_.count++ == 0) transfers_.begin = now();
    now_ += double(bytes) / bytes_per_cycle_ + 1;
    transfers_.bytes += bytes, transfers_.end = now();
  }

 private:
  double issue_width_, bytes_per_cycle_, now_ = 0;
  Transfers transfers_;
};

}  // namespace glint::vulkan
