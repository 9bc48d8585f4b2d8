// Policy: which waiting request a free DRAM bank gets next.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "base/policy_kinds.h"

namespace glint::mem {

struct DramRequest {
  uint32_t bank = 0;
  uint32_t row = 0;
  uint64_t age = 0;  // grows from request to request: smaller is older
  bool write = false;
};

// Contract (tests/contract/dram_scheduler_test.cpp):
//  - every added slot is picked exactly once, for the bank of its request;
//  - pick() answers kNone when it holds nothing for the bank, and may do so to wait for an older request
//  elsewhere,
//    but of the banks asked in turn at least one gets a request while any is held;
//  - the answer depends on the calls made and nothing else; no heap traffic after construction.
class DramScheduler {
 public:
  static constexpr PolicyKind kKind{"memory.dram.scheduler", "memsys/dram_schedulers"};
  struct Context {
    uint32_t banks = 0;
    uint32_t capacity = 0;  // slots are below this
  };
  static constexpr uint32_t kNone = ~0u;
  static constexpr uint32_t kClosed = ~0u;  // as `open_row`: the bank has none

  virtual ~DramScheduler() = default;
  virtual void add(uint32_t slot, const DramRequest& request) = 0;
  // The slot the free `bank` works on next, or kNone; the slot is forgotten.
  virtual uint32_t pick(uint32_t bank, uint32_t open_row) = 0;
};

}  // namespace glint::mem
