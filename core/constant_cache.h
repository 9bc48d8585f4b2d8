// Models a core's constant cache: which lines of constant loads it has, and which warps wait for others.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "core/code_cache.h"
#include "isa/warp.h"

namespace glint::core {

// Returns the number of different addresses at which the lanes of an access begin. Each takes a turn, whether
// or not it lies in the word of another one. Source: chains of loads on an H100 (docs/validation.md).
uint32_t different_addresses(const isa::Access& access, LaneMask lanes);

// Serves loads. A load whose lines are all present takes its fixed time; otherwise its warp waits for all of
// them.
class ConstantCache {
 public:
  // `base` is the physical address of the constant bank, which has `bytes` bytes. `client` is this cache's
  // number in the cache behind.
  ConstantCache(const ConstantParams& params, Address base, uint64_t bytes, uint32_t client, CodeCache& cache,
                CodeStats& stats);

  // Looks up the lines at `offset + access.address` of the lanes. Each access is aligned and lies in one
  // line. Returns false when the warp of `slot` has to wait until arrive().
  bool look_up(uint32_t slot, const isa::Access& access, LaneMask lanes, uint64_t offset, Cycle now);
  // Takes a line from the cache behind. `served` is called with each slot that waits for nothing any more.
  template <class Served>
  void arrive(Address line, Served&& served) {
    for (size_t i = waits_.size(); i-- > 0;) {
      if (outer(waits_[i].line) != line) continue;
      tags_.keep(waits_[i].line);
      const uint32_t slot = waits_[i].slot;
      waits_[i] = waits_.back();
      waits_.pop_back();
      if (--missing_[slot] == 0) served(slot);
    }
  }
  // This is the number of lines that a core's warps may wait for.
  static constexpr uint32_t kMost = 64 * uint32_t(kLanes);

 private:
  struct Wait {
    uint32_t slot = 0;
    Address line = 0;
  };
  Address outer(Address line) const { return line & ~Address{cache_.line_bytes() - 1}; }
  void want(uint32_t slot, Address line, Cycle now);

  const uint32_t line_bytes_, client_;
  const Address base_;
  const uint64_t bytes_;
  CodeCache& cache_;
  CodeStats& stats_;
  mem::TagArray tags_;
  std::vector<Wait> waits_;             // reserved once
  std::array<uint32_t, 64> missing_{};  // number of lines that each slot waits for
};

}  // namespace glint::core
