// Runs loads, stores, atomics, copies and barriers in memory of the lanes of a warp, in whichever space their
// addresses are.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "exec/access_rows.h"
#include "exec/constant_bank.h"
#include "exec/fault_gate.h"
#include "exec/local_memory.h"
#include "exec/seen_memory.h"
#include "isa/mbarrier.h"

namespace glint::exec {

class MemoryOps {
  // Says what a lane's access is to a message about a fault.
  struct Reach {
    isa::Space space;
    isa::Effect effect;
    uint32_t bytes;
  };

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

  // These are in async_copies.cpp and mbarriers.cpp.
  // Returns the shared addresses of the lanes' parts of the last cp.async.
  const isa::Access& copied_to() const { return copied_to_; }
  // Leaves arrivals that wait for copies to arrive_late(). Otherwise copies are done at once, and so are
  // these.
  void let_arrive_late() { arrives_late_ = true; }
  // Arrives once for each lane of an earlier cp.async.mbarrier.arrive of the warp, at `pc`. Returns false
  // after a fault.
  bool arrive_late(WarpContext& warp, uint32_t pc, const isa::Access& places, LaneMask lanes);
  // Asks again what the mbarrier.try_wait asked that the warp has executed last, for `lanes`. Returns whether
  // all of its phases have ended now.
  bool ask_again(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask lanes);

 private:
  bool access(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, isa::Space space,
              LaneMask lanes);
  bool refuse(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, isa::Space space,
              LaneMask lanes, const std::string& why);
  static bool has_effect(const WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row,
                         LaneMask lanes);
  bool locate(WarpContext& warp, const isa::OpRow& row, isa::Space space, LaneMask& lanes, LanePlaces& at);
  bool pass_outside(const WarpContext& warp, int lane, const Reach& reach, Address address);
  bool pass_misaligned(const WarpContext& warp, int lane, const Reach& reach, Address address);
  bool move_data(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, isa::Space space,
                 LaneMask lanes);
  void move_rows(WarpContext& warp, const isa::Inst& inst, isa::Effect effect, const isa::Memory& shape,
                 isa::Space space, LaneMask lanes, const LanePlaces& at);
  void move_beginnings(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask lanes);
  bool modify(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, isa::Space space,
              LaneMask lanes);

  // This function is in matrix_accesses.cpp.
  bool move_matrices(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask lanes);

  // These are in async_copies.cpp.
  bool copy(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask lanes);
  std::byte* copy_target(const WarpContext& warp, int lane, uint32_t bytes, bool& ok);
  const std::byte* copy_source(WarpContext& warp, int lane, const Reach& reach, uint32_t size, bool& ok);
  void copy_lane(std::byte* to, const std::byte* from, uint32_t bytes, uint32_t size);

  // These are in mbarriers.cpp.
  bool run_mbarrier(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask lanes);
  void ask(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, LaneMask lanes,
           const LanePlaces& at);
  void put(Block& block, std::byte* at, const isa::Mbarrier& barrier);

  const World& world_;
  FaultGate& faults_;
  SeenMemory& seen_;
  LocalMemory local_;
  ConstantBank constants_;
  std::array<LaneMask, size_t(isa::Space::Generic) + 1> lanes_in_{};
  uint64_t changes_ = 0;
  isa::Access copied_to_{};
  bool arrives_late_ = false;
};

}  // namespace glint::exec
