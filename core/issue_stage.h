// Issues instructions of a core: schedulers choose warps, whose instructions are executed and go to units.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "core/core_parts.h"

namespace glint::core {

class BarrierUnit;
class ConstantPort;
class MbarrierUnit;
class MemoryAccesses;
class RayDoor;
class ReorderUnit;
class SubwarpUnit;

class IssueStage {
 public:
  struct Units {
    MemoryAccesses& memory;
    ConstantPort& constants;
    RayDoor& rays;
    BarrierUnit& barriers;
    ReorderUnit* reorder;     // null: threads stay in their lanes
    MbarrierUnit* mbarriers;  // null: the program has no barriers in shared memory
    SubwarpUnit* subwarps;    // null: a path runs until it ends
  };
  IssueStage(const CoreParts& core, const Units& units, const Doors& doors)
      : core_(core), units_(units), doors_(doors) {}

  // Finds out what can be left out of each issue. It is called before warps of a block start.
  void start_block();
  // Gives this cycle of each scheduler in `due` (bit s: scheduler s) to an instruction or to a reason. An
  // issue may wake schedulers that come later, and then these have their turns, too.
  void run(uint32_t due, Cycle now);
  // Returns the first fault of a warp. The core does nothing from then on.
  const std::optional<exec::Fault>& fault() const { return fault_; }

 private:
  void run(Scheduler& scheduler, Cycle now);
  void issue_value(Scheduler& scheduler, uint32_t local, WarpSlot& at, const IssueRow& row, Cycle now);
  uint64_t leave_out_bank_conflicts(Scheduler& scheduler, uint64_t ready, Cycle now) const;
  uint64_t leave_out_held(Scheduler& scheduler, uint64_t ready, Cycle now) const;
  void issue(uint32_t slot, Cycle now);
  void hand_over(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle late, Cycle now);
  void finish_fixed(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle late, Cycle now);
  void look_for_slow_path(const exec::WarpContext& warp, const IssueRow& row);
  void start_sequence(WarpSlot& at, const IssueRow& row, uint32_t pc, Cycle now);
  void take_turns(uint32_t slot, const IssueRow& row, LaneMask before, Cycle now);
  void prepare_next(WarpSlot& at, Cycle now);
  void issue_rest(uint32_t slot, Cycle now);
  void tell_select(uint32_t slot, Cycle now) const;
  uint32_t blamed_pc(const Scheduler& scheduler, Cycle now) const;

  const CoreParts core_;
  const Units units_;
  const Doors doors_;
  std::optional<exec::Fault> fault_;
  // An instruction that only computes values changes nothing but its registers, its pipe and its counts:
  // nobody listens, and the core has none of the parts that make more of it.
  bool is_plain_ = false;
  SlowTime slow_;  // what the operands of the last whole instruction add to it
};

}  // namespace glint::core
