// One core: warp slots, schedulers and units, wired together and taken through time.
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
#include "core/memory_accesses.h"
#include "core/params.h"
#include "core/ray_door.h"
#include "core/warp_slots.h"
#include "engine/engine.h"
#include "exec/executor.h"
#include "exec/memory_view.h"
#include "memsys/l1_port.h"
#include "memsys/latency.h"
#include "rtunit/rt_port.h"

namespace glint::core {

// A cycle, in order: L1, RT unit and load-store unit; their answers wake warps; each scheduler issues one
// instruction, which is executed at once and charged for afterwards. Cycles in which nothing can happen are
// skipped, and give the same result as stepping through them.
class CoreCell final : public Cell {
 public:
  struct Context {
    const exec::World& world;
    mem::L1Port& l1;             // The core ticks it, and its next_event covers what the core waits for.
    rt::RtPort& rt;              // The core ticks it.
    Address local_physical = 0;  // The stacks of this core's lanes: local_bytes() bytes.
    stats::Group* parent = nullptr;
    std::string name = "core";  // Name of the statistics: "core[3]".
    bool no_skip = false;       // Steps every cycle: slow, for checking.
    uint32_t index = 0, cores = 1;
    double clock_mhz = 0.0;  // 0: programs read no time.
    Address tables = 0;      // Physical: the candidates of the core's rays, table_bytes() bytes.
    CodePlaces places;       // Used where the caches of instructions or constants are not perfect.
    Cycle turn = 0;  // Cycles after which other cores see what this one wrote. 0: there are no others.
  };
  // Program and parameters must have passed check().
  CoreCell(const Params& params, const Context& context);
  ~CoreCell() override;

  // Bytes of simulated memory that a core's lanes need for their stacks.
  static uint64_t local_bytes(const Params& params, const exec::World& world);
  // Bytes that a core needs for the candidates of its rays, in the deferred any-hit mode.
  static rt::TableLayout table_layout(const exec::World& world, Address base);
  static uint64_t table_bytes(const Params& params, const exec::World& world);
  // Bytes that all cores together need for instructions and for constants. 0: these are always there.
  static uint64_t code_bytes(const Params& params, const exec::World& world);
  static uint64_t constant_bytes(const Params& params, const exec::World& world);

  // Launching, between windows only.
  uint32_t num_slots() const { return warps_.size(); }
  uint32_t num_resident() const { return warps_.num_resident(); }
  // Room for a whole block: warp slots, shared memory, and a block's place.
  // Model: a warp's slot and registers are free when the warp has ended; hardware keeps them until the block
  // has.
  bool has_room() const;
  // Blocks and warps that fit at a time, and what limits them.
  static LaunchNeeds needs_of(const exec::World& world);
  // Puts block `block_index` of the launch into the lowest free slots. Its first instructions can issue at
  // `ready`.
  void launch(Cycle now, uint32_t block_index, Cycle ready);

  // Cell.
  void advance(Cycle from, Cycle until) override;
  Cycle next_event(Cycle from) const override;
  bool finished() const override {
    return warps_.num_resident() == 0 && lsu_.idle() && (!code_ || code_->idle()) &&
           l1_.next_event(accounted_) == kNever;  // The last writes have left.
  }
  uint64_t progress() const override { return counts_.progress; }
  // Grows when a warp begins, ends or is handed to the RT unit, and with what exec::Executor::changes()
  // counts. Warps that spin for ever change none of these.
  uint64_t changes() const;
  std::string describe_stall() const override;

  // The first fault of a warp here; the cell does nothing from then on.
  const std::optional<exec::Fault>& fault() const { return issue_.fault(); }
  // What went wrong here and was let pass.
  const exec::FaultLog& passed() const { return executor_.passed(); }
  // The cycle after the last one in which anything happened here.
  Cycle active_until() const { return accounted_; }
  // Gives the cycles up to `end` to their reasons: once, at the end of the run. `end` >= active_until().
  void finish(Cycle end);

  exec::Executor& executor() { return executor_; }  // To listen to what retires.
  // What the core has done to global memory in the present turn; null without other cores.
  exec::MemoryView* view() { return view_.get(); }
  const CoreStats& stats() const { return counts_.stats; }
  // Counts by instruction too, from before the first launch on; otherwise there is no profile.
  void start_profile();
  const Profile* profile() const { return counts_.profile.get(); }
  // Tells `observer`, which outlives the run, of all that happens from now on; before the first launch.
  void observe(CoreObserver& observer);
  // The lanes of access `access`, the token of its requests, that touch a line. `slot`: the slot of their
  // warp.
  LaneMask readers_of(mem::Token access, Address line, uint32_t& slot) const {
    return memory_.readers_of(access, line, slot);
  }
  IntervalSampler& sampler() { return sampler_; }
  // Warp instructions and lanes by op, indexed as isa::op_table().
  const std::vector<uint64_t>& op_counts() const { return counts_.op_counts; }
  const std::vector<uint64_t>& op_lanes() const { return counts_.op_lanes; }
  // Cycles of every warp instruction that waits for memory, from its issue to its last sector.
  const mem::Latencies& latencies() const { return counts_.latencies; }

 private:
  void launch_warp(BlockPlace& home, uint32_t warp_in_block, Cycle ready, Cycle now);
  void step(Cycle now);
  void account_until(Cycle now);
  void become_empty();
  CoreParts parts() { return {params_, world_, table_, executor_, warps_, counts_, observers_}; }

  const Params params_;
  const exec::World& world_;
  mem::L1Port& l1_;
  rt::RtPort& rt_;
  const bool no_skip_;
  const IssueTable table_;
  exec::Executor executor_;
  const std::unique_ptr<exec::MemoryView> view_;
  CoreCounts counts_;
  CoreObservers observers_;
  const std::unique_ptr<CodeSupply> code_;  // Null where instructions and constants are always there.
  WarpSlots warps_;
  Lsu lsu_;
  MemoryAccesses memory_;
  ConstantPort constants_;
  RayDoor rays_;
  BarrierUnit barriers_;
  IssueStage issue_;
  exec::Seat seat_;        // The seat of the warp launched last.
  Cycle block_start_ = 0;  // When the first instructions of the block launched last can issue.
  Cycle accounted_ = 0;    // Every cycle before has been given to a reason.
  IntervalSampler sampler_;
};

}  // namespace glint::core
