// Runs accesses to local memory, which is the stack of each lane.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "exec/fault_gate.h"
#include "isa/op_row.h"

namespace glint::exec {

// Runs accesses. Words of local memory lie side by side for all lanes, so a vector may start at any word, as
// spills do.
class LocalMemory {
 public:
  LocalMemory(const World& world, FaultGate& faults) : world_(world), faults_(faults) {}

  // Loads or stores for the lanes of `made`. Lanes whose access was let pass and went nowhere leave it.
  // Returns false after a fault.
  bool access(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask& made);

 private:
  static void move_rows(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, Address address,
                        LaneMask lanes);
  bool check(WarpContext& warp, const isa::OpRow& row, LaneMask& lanes);

  const World& world_;
  FaultGate& faults_;
};

}  // namespace glint::exec
