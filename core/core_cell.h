// One core: resident warps, their schedulers and execution units, and the doors to its L1 and RT unit.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/interval_sampler.h"
#include "core/constant_cache.h"
#include "core/core_observer.h"
#include "core/instruction_fetch.h"
#include "core/issue_scheduler.h"
#include "core/lsu.h"
#include "core/params.h"
#include "core/profile.h"
#include "core/scoreboard.h"
#include "core/sm_scheduler.h"
#include "core/sm_stats.h"
#include "core/units.h"
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
    mem::L1Port& l1;             // ticked here; its next_event covers what it waits for
    rt::RtPort& rt;              // ticked here
    Address local_physical = 0;  // of local_bytes() bytes: the stacks of this core's lanes
    stats::Group* parent = nullptr;
    std::string name = "core";  // of its statistics: "core[3]"
    bool no_skip = false;       // steps every cycle: slow, for checking
    uint32_t index = 0, cores = 1;
    double clock_mhz = 0.0;  // 0: programs read no time
    Address tables = 0;      // physical, of table_bytes() bytes: the candidates of its rays
    Address code = 0,
            constants =
                0;   // physical: the image's instructions, the constant bank; if their caches are not perfect
    Cycle turn = 0;  // after which other cores see what this one has written; 0: there are none
  };
  // Program and parameters must have passed check().
  CoreCell(const Params& params, const Context& context);
  ~CoreCell() override;

  // Simulated memory that a core's lanes need for their stacks, in bytes.
  static uint64_t local_bytes(const Params& params, const exec::World& world);
  // And for candidates, in the deferred any-hit mode.
  static rt::TableLayout table_layout(const exec::World& world, Address base);
  static uint64_t table_bytes(const Params& params, const exec::World& world);
  // And, of all cores together, for instructions and constants; 0 where those are always there.
  static uint64_t code_bytes(const Params& params, const exec::World& world);
  static uint64_t constant_bytes(const Params& params, const exec::World& world);

  // Launching, between windows only.
  uint32_t num_slots() const { return num_slots_; }
  uint32_t num_resident() const { return num_resident_; }
  // Room for a whole block: warp slots, shared memory, and a block's place.
  // Model: a warp's slot and registers are free when the warp has ended; hardware keeps them until the block
  // has.
  bool has_room() const;
  // Blocks and warps that fit at a time, and what limits them.
  static LaunchNeeds needs_of(const exec::World& world);
  // Puts block `block_index` of the launch into the lowest free slots; its first instructions can issue at
  // `ready`.
  void launch(Cycle now, uint32_t block_index, Cycle ready);

  // Cell.
  void advance(Cycle from, Cycle until) override;
  Cycle next_event(Cycle from) const override;
  bool finished() const override {
    return num_resident_ == 0 && lsu_.idle() && (!code_ || code_->cache.idle()) &&
           l1_.next_event(accounted_) == kNever;  // last writes have left
  }
  uint64_t progress() const override { return progress_; }
  // Grows when a warp begins, ends or is handed to the RT unit, and with what exec::Executor::changes()
  // counts: what warps that spin for ever do not.
  uint64_t changes() const {
    return num_launched_ - num_resident_ + num_launched_ + stats_.rt_warps.value() + executor_.changes();
  }
  std::string describe_stall() const override;

  // The first fault of a warp here; the cell does nothing from then on.
  const std::optional<exec::Fault>& fault() const { return fault_; }
  // What went wrong here and was let pass.
  const exec::FaultLog& passed() const { return executor_.passed(); }
  // Cycle after the last one in which anything happened here.
  Cycle active_until() const { return accounted_; }
  // Gives the cycles up to `end` to their reasons: once, at the end of the run. `end` >= active_until().
  void finish(Cycle end);

  exec::Executor& executor() { return executor_; }  // to listen to what retires
  // What the core has done to global memory in the present turn; null without other cores.
  exec::MemoryView* view() { return view_.get(); }
  const CoreStats& stats() const { return stats_; }
  // Counts by instruction too, from before the first launch on; otherwise there is no profile.
  void start_profile();
  const Profile* profile() const { return profile_.get(); }
  // Tells `observer`, which outlives the run, of all that happens from now on; before the first launch.
  void observe(CoreObserver& observer);
  // The lanes of access `access`, the token of its requests, that touch a line; `slot`: of their warp.
  LaneMask readers_of(mem::Token access, Address line, uint32_t& slot) const;
  IntervalSampler& sampler() { return sampler_; }
  // Warp instructions and lanes by op, indexed as isa::op_table().
  const std::vector<uint64_t>& op_counts() const { return op_counts_; }
  const std::vector<uint64_t>& op_lanes() const { return op_lanes_; }
  // Of every warp instruction that waits for memory, from its issue to its last sector.
  const mem::Latencies& latencies() const { return latencies_; }

 private:
  // A block that is here: until all of its warps' accesses have ended.
  struct Resident {
    exec::Block block;
    uint32_t warps = 0;  // of it that hold a slot; 0: the place is free
  };

  // Caches of instructions and constants; a pointer is null where they are perfect.
  struct Code {
    Code(const Params& params, const Context& context, CodeStats& stats);
    CodeCache cache;
    std::unique_ptr<InstructionFetch> fetch;
    std::unique_ptr<ConstantCache> constants;
  };

  void launch_warp(Resident& home, uint32_t warp_in_block, Cycle ready);
  void step(Cycle now);
  void account_until(Cycle now);
  SchedulerState& scheduler_of(uint32_t slot) { return schedulers_[slot % params_.schedulers]; }
  void run_scheduler(SchedulerState& scheduler, Cycle now);
  std::string describe_warp(uint32_t slot) const;
  Stall reason_of(const SchedulerState& scheduler, size_t warp, Cycle now) const;
  uint32_t blamed_pc(const SchedulerState& scheduler, Cycle now) const;
  uint64_t find_ready(SchedulerState& scheduler, Cycle now);
  uint64_t leave_out_bank_conflicts(SchedulerState& scheduler, uint64_t free, Cycle now, Cycle& next) const;
  void read_banks(SchedulerState& scheduler, uint32_t pc, Cycle now);
  Scoreboard::Ready operands_ready(uint32_t slot, const IssueRow& row) const;
  void issue(SchedulerState& scheduler, uint32_t local, Cycle now);
  void start_sequence(uint32_t slot, const IssueRow& row, uint32_t pc, Cycle now);
  void issue_rest(SchedulerState& scheduler, uint32_t slot, Cycle now);
  void refresh_sequence(SchedulerState& scheduler, uint32_t slot);
  void count(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now);
  void count_access(const isa::OpRow& op);
  bool start_access(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now);
  void collect_lines(MemoryAccess& access, const exec::Issued& issued);
  void collect_texels(MemoryAccess& access, LaneMask lanes);
  void collect_candidates(MemoryAccess& access, LaneMask lanes);
  void come_to_barrier(uint32_t slot, Cycle now, Cycle latency);
  void pass_barrier(const exec::Block& block, Cycle at);
  Cycle turn_end(Cycle now) const { return turn_ ? (now / turn_ + 1) * turn_ : 0; }
  void start_fence(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now);
  void collect_memory(MemoryAccess& access, const exec::Issued& issued);
  void start_rays(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now);
  void complete(uint32_t access_id, Cycle now);
  void read_operands(uint32_t access_id, Cycle now);
  uint32_t war_latency(const MemoryAccess& access) const {
    return access.lines.lines().empty() ? params_.lsu.shared_war_latency : params_.lsu.war_latency;
  }
  void finish_constant(uint32_t slot, Cycle now);
  void start_constant(SchedulerState& scheduler, uint32_t slot, const IssueRow& row,
                      const exec::Issued& issued, Cycle now);
  void come_to_line(uint32_t slot);
  void take_code(Cycle now);
  void complete_rays(uint32_t slot, Cycle now);
  void retire(uint32_t slot);
  void free_slot(uint32_t slot);
  void tell_select(const SchedulerState& scheduler, uint32_t slot, Cycle now) const;
  void refresh(uint32_t slot);

  const Params params_;
  const exec::World& world_;
  mem::L1Port& l1_;
  rt::RtPort& rt_;
  const bool no_skip_;
  const uint32_t num_slots_;
  const LocalLayout local_;
  const rt::TableLayout tables_;
  IssueTable table_;
  exec::Executor executor_;
  const Cycle turn_;
  const bool holds_operands_, times_constants_;
  std::unique_ptr<exec::MemoryView> view_;
  Lsu lsu_;
  std::vector<SchedulerState> schedulers_;
  std::vector<exec::WarpContext> warps_;
  std::vector<Scoreboard> scoreboards_;
  std::vector<Scoreboard::Ready>
      front_;                          // a slot: before this the warp issues nothing, whatever the registers
  std::vector<uint32_t> outstanding_;  // a slot: accesses in flight
  std::vector<uint8_t>
      stored_;  // a slot: whether there was a store to global memory since the last fence among cores
  std::vector<Cycle> fence_;     // a slot: latency of the fence that waits for them; 0: none
  std::vector<Resident*> home_;  // a slot: the block of its warp
  std::vector<std::unique_ptr<Resident>> residents_;
  const uint32_t warps_per_block_;
  exec::Seat seat_;             // of the warp launched last
  uint32_t num_blocks_ = 0;     // resident
  std::vector<uint32_t> line_;  // a slot: line of instructions that the warp is in or waits for
  std::vector<uint8_t> waits_for_line_;
  struct ConstantLoad {
    uint32_t pc = 0;
    Cycle issued = 0, latency = 0;  // of a hit
  };
  std::vector<ConstantLoad> constant_;  // a slot: its last one
  static constexpr uint32_t kPrologue = ~0u;
  struct Sequence {
    uint32_t left = 0, pc = kPrologue;  // instructions still to issue; of the op that they make up
    Cycle step = 1, last = 1;           // cycles between them; from the last one to the result
  };
  std::vector<Sequence> sequence_;  // a slot
  Cycle now_ = 0;                   // of the present step or launch
  Cycle block_start_ = 0;           // of the block launched last
  Cycle barrier_free_ = 0;          // of the core's barrier unit
  std::vector<Cycle> rays_issued_;  // a slot: when its rays were handed over
  std::vector<uint32_t> rays_pc_;
  std::vector<LaneMask> rays_lanes_;
  uint32_t num_resident_ = 0;
  uint64_t num_launched_ = 0, progress_ = 0;
  Cycle accounted_ = 0;  // every cycle before has been given to a reason
  std::optional<exec::Fault> fault_;
  CoreStats stats_;
  std::unique_ptr<CodeStats> code_stats_;  // null where instructions and constants are always there, as is:
  std::unique_ptr<Code> code_;
  std::vector<uint64_t> op_counts_, op_lanes_;
  mem::Latencies latencies_;
  std::unique_ptr<Profile> profile_;  // null: not asked for
  std::vector<CoreObserver*> observers_;
  IntervalSampler sampler_;
};

}  // namespace glint::core
