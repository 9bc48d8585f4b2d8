// Wires warp slots, schedulers and units together to one core, and takes it through time.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/interval_sampler.h"
#include "core/barrier_unit.h"
#include "core/code_supply.h"
#include "core/constant_port.h"
#include "core/core_observer.h"
#include "core/core_parts.h"
#include "core/issue_stage.h"
#include "core/lsu.h"
#include "core/mbarrier_unit.h"
#include "core/memory_accesses.h"
#include "core/params.h"
#include "core/parking_lot.h"
#include "core/ray_door.h"
#include "core/reorder_unit.h"
#include "core/residency.h"
#include "core/subwarp_unit.h"
#include "core/warp_slots.h"
#include "engine/engine.h"
#include "exec/executor.h"
#include "exec/memory_view.h"
#include "memsys/l1_port.h"
#include "memsys/latency.h"
#include "rtunit/rt_port.h"

namespace glint::core {

// Goes through a cycle in this order: L1, RT unit and load-store unit; then their answers wake warps; then
// each scheduler issues one instruction, which is executed at once and whose time is charged afterwards.
// Cycles in which nothing can happen are skipped, which gives the same result as stepping through them.
class CoreCell final : public Cell {
 public:
  struct Context {
    const exec::World& world;
    mem::L1Port& l1;             // the core ticks it, and its next_event covers what the core waits for
    rt::RtPort& rt;              // the core ticks it
    Address local_physical = 0;  // stacks of this core's lanes, with local_bytes() bytes
    stats::Group* parent = nullptr;
    std::string name = "core";  // name of the statistics: "core[3]"
    bool no_skip = false;       // steps through every cycle, which is slow; for checking
    uint32_t index = 0, cores = 1;
    double clock_mhz = 0.0;  // 0: programs read no time
    Address tables = 0;  // physical address of the candidates of the core's rays, with table_bytes() bytes
    CodePlaces places;   // used when the caches of instructions or constants are not perfect
    Cycle turn = 0;      // cycles after which other cores see what this one wrote; 0: there are no others
    uint32_t shared_per_warp = 0;  // bytes of shared memory that the RT unit takes for each warp
    uint8_t* news = nullptr;       // where the core says, for the time between windows, what is new (News)
    // It belongs to the program and the parameters, and cores share it. null: the core makes its own.
    std::shared_ptr<const IssueTable> table = nullptr;
  };
  // Says what somebody has to look at between windows. A core writes these bits when they have changed, so
  // that a machine reads one byte of each core and not its state.
  enum News : uint8_t { kHasEffects = 1, kHasFault = 2, kHasRoom = 4 };
  // The program and the parameters must have passed check().
  CoreCell(const Params& params, const Context& context);
  ~CoreCell() override;

  // Returns the layout of a core's stacks and rays from `base` on, and the bytes of simulated memory that
  // they need.
  static LocalLayout local_layout(const Params& params, const exec::World& world, Address base);
  static uint64_t local_bytes(const Params& params, const exec::World& world);
  // Returns the layout of the candidates of a core's rays in the deferred any-hit mode.
  static rt::TableLayout table_layout(const exec::World& world, Address base);
  static uint64_t table_bytes(const Params& params, const exec::World& world);
  // Returns the bytes that all cores together need for instructions and constants, or 0 when these are always
  // present.
  static uint64_t code_bytes(const Params& params, const exec::World& world);
  static uint64_t constant_bytes(const Params& params, const exec::World& world);

  // These serve launching, between windows only.
  uint32_t num_slots() const { return warps_.size(); }
  // Returns the number of slots of a core, which is larger than that of warps that can run when warps may
  // give up their places (core/parking.h).
  static uint32_t num_slots(const Params& params, const exec::World& world);
  uint32_t num_resident() const { return warps_.num_resident(); }
  // Returns a resident warp for which `is_wanted` holds, in the order of slots, or null.
  template <class IsWanted>
  const exec::WarpContext* find_warp(IsWanted&& is_wanted) const {
    for (uint32_t slot = 0; slot < warps_.size(); ++slot)
      if (warps_.is_resident(slot) && is_wanted(warps_[slot].warp)) return &warps_[slot].warp;
    return nullptr;
  }
  // Returns whether there is room for a whole block: places and slots of warps, shared memory, and a block
  // slot. Model: a warp's slot and registers are free when the warp has ended; hardware keeps them until the
  // block has ended.
  bool has_room() const;
  // Returns how many blocks and warps fit at a time, and what limits them.
  static LaunchNeeds needs_of(const exec::World& world, uint32_t shared_per_warp = 0);
  // Puts block `block_index` of the launch into the lowest free slots. Its first instructions can issue at
  // `ready`.
  void launch(Cycle now, uint32_t block_index, Cycle ready);
  // Notes that no block of the launch is left.
  void end_of_blocks() {
    if (parking_) parking_->end_of_blocks();
  }

  // These implement Cell.
  void advance(Cycle from, Cycle until) override;
  Cycle next_event(Cycle from) const override;
  bool finished() const override {
    return warps_.num_resident() == 0 && lsu_.idle() && (!code_ || code_->idle()) &&
           l1_.next_event(active_until_) == kNever;  // The last writes have left.
  }
  uint64_t progress() const override { return counts_.progress; }
  // Returns a number that grows when a warp begins, ends or is handed to the RT unit, and with what
  // exec::Executor::changes() counts. Warps that spin for ever change none of these.
  uint64_t changes() const;
  // Returns a number that grows when a warp begins or ends.
  uint64_t turnover() const;
  std::string describe_stall() const override;

  // Returns the first fault of a warp here. The cell does nothing from then on.
  const std::optional<exec::Fault>& fault() const { return issue_.fault(); }
  // Returns what went wrong here and was let pass.
  const exec::FaultLog& passed() const { return executor_.passed(); }
  // Returns the cycle after the last one in which anything happened here.
  Cycle active_until() const { return active_until_; }
  // Gives the cycles up to `end` to their reasons. It is called once, at the end of the run, with `end` >=
  // active_until().
  void finish(Cycle end);

  exec::Executor& executor() { return executor_; }  // for listening to what retires
  const exec::Executor& executor() const { return executor_; }
  // Returns what the core has done to global memory in the present turn, or null without other cores.
  exec::MemoryView* view() { return view_.get(); }
  const CoreStats& stats() const { return counts_.stats; }
  // Starts to count by instruction. It is called before the first launch; otherwise there is no profile.
  void start_profile();
  const Profile* profile() const { return counts_.profile.get(); }
  // Tells `observer`, which outlives the run, of all that happens from now on. It is called before the first
  // launch.
  void observe(CoreObserver& observer);
  // Return whether a policy hears what the L1 does, and tell it so: core/l1_listener.h. `access` is the token
  // of a request of the load-store unit; there is none for a request of the RT unit.
  bool hears_l1();
  void start_l1(uint32_t lines);
  void tell_missed(mem::Token access, Address line);
  void tell_replaced(uint32_t place, std::optional<mem::Token> access, std::optional<Address> victim);
  // Returns the lanes of access `access`, the token of its requests, that touch a line. `slot` becomes the
  // slot of their warp.
  LaneMask readers_of(mem::Token access, Address line, uint32_t& slot) const {
    return memory_.readers_of(access, line, slot);
  }
  IntervalSampler& sampler() { return sampler_; }
  // Return warp instructions and lanes by op, indexed as isa::op_table(). They are complete after finish().
  const std::vector<uint64_t>& op_counts() const { return counts_.op_counts; }
  const std::vector<uint64_t>& op_lanes() const { return counts_.op_lanes; }
  // Returns the cycles of every warp instruction that waits for memory, from its issue to its last sector.
  const mem::Latencies& latencies() const { return counts_.latencies; }

 private:
  void tell_news();
  void launch_warp(BlockSlot& home, uint32_t warp_in_block, Cycle ready, Cycle now);
  void step(Cycle now);
  void issue(Cycle now);
  uint32_t find_open_doors(uint32_t watching) const;
  // Returns the number of warps that hold registers.
  uint32_t num_held() const { return warps_.num_resident() - (parking_ ? parking_->num_parked() : 0); }
  void count_residents(Cycle now);
  void become_empty(Cycle now);
  CoreParts parts() { return {params_, world_, *table_, executor_, warps_, counts_, observers_}; }

  const Params params_;
  const exec::World& world_;
  mem::L1Port& l1_;
  rt::RtPort& rt_;
  const bool no_skip_;
  const uint64_t shared_per_block_;
  const std::shared_ptr<const IssueTable> table_;
  exec::Executor executor_;
  const std::unique_ptr<exec::MemoryView> view_;
  CoreCounts counts_;
  CoreObservers observers_;
  const std::unique_ptr<CodeSupply> code_;  // null when instructions and constants are always present
  const uint32_t places_;                   // warps that can run at a time
  WarpSlots warps_;
  Lsu lsu_;
  const Doors doors_{lsu_, rt_};
  const std::unique_ptr<MbarrierUnit> mbarriers_;  // null when the program has none
  const std::unique_ptr<SubwarpUnit> subwarps_;    // null when a path runs until it ends
  MemoryAccesses memory_;
  ConstantPort constants_;
  const std::unique_ptr<ParkingLot> parking_;  // null when warps keep their places
  RayDoor rays_;
  BarrierUnit barriers_;
  const std::unique_ptr<ReorderUnit> reorder_;  // null when threads stay in their lanes
  IssueStage issue_;
  exec::Seat seat_;                    // the seat of the warp launched last
  Cycle block_start_ = 0;              // when the first instructions of the block launched last can issue
  uint32_t residents_ = 0, held_ = 0;  // resident warps and held places since cycle residents_since_
  Cycle residents_since_ = 0;
  Cycle active_until_ = 0;  // nothing has happened in this cycle or after it
  IntervalSampler sampler_;
  uint8_t* const news_;  // null when nobody reads it
  uint8_t told_;         // the bits that were written last
};

}  // namespace glint::core
