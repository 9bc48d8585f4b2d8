// Models a core's constant port: loads from the constant bank, which may miss in the constant cache.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "core/constant_cache.h"
#include "core/core_parts.h"

namespace glint::core {

class ConstantPort {
 public:
  // `cache` is null when every load hits.
  ConstantPort(const CoreParts& core, ConstantCache* cache);

  // Returns whether constant loads take other times than their unit's. Otherwise this port has nothing to do
  // with them.
  bool is_timed() const { return is_timed_; }
  void start(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now);
  // Notes that a line has come from the cache behind. Loads that waited for nothing else have their result.
  void take_line(Address line, Cycle now);

 private:
  struct Load {
    uint32_t pc = 0;
    Cycle issued = 0;
    Cycle latency = 0;  // cycles from a hit to the result
  };
  void finish(uint32_t slot, Cycle now);

  const CoreParts core_;
  ConstantCache* const cache_;
  const bool is_serial_, is_timed_;
  std::vector<Load> loads_;  // the last load of each slot
};

}  // namespace glint::core
