// Interface: chooses which waiting request a free DRAM bank gets next.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "base/registry.h"

namespace glint::mem {

struct DramRequest {
  uint32_t bank = 0;
  uint32_t row = 0;
  uint64_t age = 0;  // number in order of arrival: the older of two requests has the smaller one
  bool write = false;
};

// Contract (tests/contract/memsys/dram_scheduler_test.cpp):
//  - Every slot that was added is picked exactly once, for the bank of its request.
//  - pick() returns kNone when no request for the bank waits. It may also return kNone so that an older
//    request of another bank goes first, but while any request waits, at least one of all banks gets one.
//  - The answer depends on the calls made and on nothing else.
//  - The scheduler allocates nothing after its construction.
class DramScheduler {
 public:
  static constexpr PolicyKind kKind{"memory.dram.scheduler", "memsys/dram_schedulers"};
  struct Context {
    uint32_t banks = 0;
    uint32_t capacity = 0;  // number of slots
  };
  static constexpr uint32_t kNone = ~0u;
  static constexpr uint32_t kClosed = ~0u;  // value of `open_row` for a bank without an open row

  virtual ~DramScheduler() = default;
  virtual void add(uint32_t slot, const DramRequest& request) = 0;
  // Returns the slot that the free `bank` works on next, or kNone. The scheduler forgets the slot.
  virtual uint32_t pick(uint32_t bank, uint32_t open_row) = 0;
};

}  // namespace glint::mem
