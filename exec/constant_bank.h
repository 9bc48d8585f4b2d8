// Loads from the constant bank: descriptors, push constants and the parameters of a kernel, which are
// read-only.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "exec/fault_gate.h"
#include "isa/op_row.h"

namespace glint::exec {

class ConstantBank {
 public:
  ConstantBank(const World& world, FaultGate& faults) : world_(world), faults_(faults) {}

  // Loads from `space`, which is Const or Param. Returns false after a fault.
  bool load(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, isa::Space space,
            LaneMask lanes);

 private:
  const World& world_;
  FaultGate& faults_;
};

}  // namespace glint::exec
