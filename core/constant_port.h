// The constant port of a core: loads from the constant bank, which may miss in the constant cache.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "core/constant_cache.h"
#include "core/core_parts.h"

namespace glint::core {

class ConstantPort {
 public:
  // `cache` is null where every load hits.
  ConstantPort(const CoreParts& core, ConstantCache* cache);

  // Whether constant loads take other times than their unit's: otherwise they are no matter of this port.
  bool is_timed() const { return is_timed_; }
  void start(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now);
  // A line has come from the cache behind: loads that waited for nothing else have their result.
  void take_line(Address line, Cycle now);

 private:
  struct Load {
    uint32_t pc = 0;
    Cycle issued = 0;
    Cycle latency = 0;  // Cycles from a hit to the result.
  };
  void finish(uint32_t slot, Cycle now);

  const CoreParts core_;
  ConstantCache* const cache_;
  const bool is_serial_, is_timed_;
  std::vector<Load> loads_;  // The last load of each slot.
};

}  // namespace glint::core
