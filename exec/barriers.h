// Barriers: warps of a block that wait for each other, and what becomes of warps that wait in vain.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "exec/fault_gate.h"
#include "isa/op_row.h"

namespace glint::exec {

// A bar.* that has to wait leaves `warp.waiting_at_barrier` set, until another warp opens the barrier.
class Barriers {
 public:
  Barriers(const World& world, FaultGate& faults) : world_(world), faults_(faults) {}

  // False after a fault.
  bool run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  // The warp has ended: barriers that wait for all warps may be complete without it. False after a fault.
  bool end_warp(WarpContext& warp);

 private:
  bool check(WarpContext& warp, uint32_t barrier, uint32_t threads);
  void open(Block& block, uint32_t barrier);
  bool fail_stuck(const Block& block);

  const World& world_;
  FaultGate& faults_;
};

}  // namespace glint::exec
