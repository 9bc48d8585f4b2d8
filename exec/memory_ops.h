// Runs loads, stores and atomics of the lanes of a warp, in whichever space their addresses are.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "exec/access_rows.h"
#include "exec/constant_bank.h"
#include "exec/fault_gate.h"
#include "exec/local_memory.h"
#include "exec/seen_memory.h"

namespace glint::exec {

class MemoryOps {
 public:
  MemoryOps(const World& world, FaultGate& faults, SeenMemory& seen)
      : world_(world), faults_(faults), seen_(seen), local_(world, faults), constants_(world, faults) {}

  // Returns false after a fault.
  bool run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);

  // Returns the lanes whose access the last run() made in that space. Their Access::address is then an
  // address of the space, also for generic accesses. Lanes whose access was let pass and went nowhere are
  // left out.
  LaneMask lanes_in(isa::Space space) const { return lanes_in_[size_t(space)]; }
  // Returns a number that grows with every store outside of a view, and with every atomic outside of a view
  // that has changed something. Most of these are in shared memory.
  uint64_t changes() const { return changes_; }

 private:
  bool access(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, isa::Space space,
              LaneMask lanes);
  bool refuse(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, isa::Space space,
              LaneMask lanes, const std::string& why);
  bool locate(WarpContext& warp, const isa::OpRow& row, isa::Space space, LaneMask& lanes, LanePlaces& at);
  bool move_data(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, isa::Space space,
                 LaneMask lanes);
  void move_rows(WarpContext& warp, const isa::Inst& inst, isa::Effect effect, const isa::Memory& shape,
                 isa::Space space, LaneMask lanes, const LanePlaces& at);
  void move_beginnings(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask lanes);
  bool modify(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, isa::Space space,
              LaneMask lanes);

  const World& world_;
  FaultGate& faults_;
  SeenMemory& seen_;
  LocalMemory local_;
  ConstantBank constants_;
  std::array<LaneMask, size_t(isa::Space::Generic) + 1> lanes_in_{};
  uint64_t changes_ = 0;
};

}  // namespace glint::exec
