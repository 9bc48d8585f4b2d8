// Runs barriers: warps of a block wait for each other, and those that wait in vain are a fault.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "exec/fault_gate.h"
#include "isa/op_row.h"

namespace glint::exec {

// Runs bar.*. A warp that has to wait keeps `warp.waiting_at_barrier` set, until another warp opens the
// barrier.
class Barriers {
 public:
  Barriers(const World& world, FaultGate& faults) : world_(world), faults_(faults) {}

  // Returns false after a fault.
  bool run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  // Notes that the warp has ended. Barriers that wait for all warps may be complete without it. Returns false
  // after a fault.
  bool end_warp(WarpContext& warp);

 private:
  bool come_divided(const WarpContext& warp, const isa::OpRow& row);
  bool check(WarpContext& warp, uint32_t barrier, uint32_t threads);
  void open(Block& block, uint32_t barrier);
  bool fail_stuck(const Block& block);

  const World& world_;
  FaultGate& faults_;
};

}  // namespace glint::exec
