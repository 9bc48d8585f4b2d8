// Executes instructions of a warp. Only here does an effect meet memory, control flow and rays.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>

#include "base/probe.h"
#include "exec/barriers.h"
#include "exec/candidates.h"
#include "exec/code_traversal.h"
#include "exec/control.h"
#include "exec/fault_gate.h"
#include "exec/hit_objects.h"
#include "exec/image.h"
#include "exec/image_ops.h"
#include "exec/launch.h"
#include "exec/memory_ops.h"
#include "exec/ray_faults.h"
#include "exec/ray_queries.h"
#include "exec/rays.h"
#include "exec/reorder_calls.h"
#include "exec/seen_memory.h"
#include "exec/shader_calls.h"
#include "exec/warp_context.h"
#include "isa/op_row.h"

namespace glint::exec {

// Says what one executed instruction did: everything that a unit of the timing machine needs to charge for
// it.
struct Issued {
  uint32_t pc = 0;
  const isa::Inst* inst = nullptr;
  const isa::OpRow* row = nullptr;
  LaneMask lanes = 0;   // lanes that executed it: active, and let through by the guard
  LaneMask active = 0;  // lanes that were running
  // Loads, stores, texture and surface ops leave their addresses in warp.regs.access until the next
  // execute(). Texture and surface ops touched texels(). For shader calls, `lanes` are the lanes that called,
  // and address[lane] is the binding-table record of each of them.
  bool finished = false;  // the warp has ended
};

// Describes one instruction that a warp has executed, for listeners such as co-simulation and traces.
struct Retired {
  const WarpContext& warp;  // its registers after the instruction
  const Issued& issued;
};

// Executes instructions. Both machines use it, so their results cannot differ; the timing machine only adds
// when things happen. Each family of effects is an object of its own.
class Executor {
 public:
  Probe<Retired> retired;
  Probe<Called> called;

  // `clock_mhz` turns cycles into the time that programs read. With 0 they read 0.
  explicit Executor(const World& world, double clock_mhz = 0.0);
  Executor(const Executor&) = delete;  // The families refer to each other.
  Executor& operator=(const Executor&) = delete;

  uint32_t num_blocks() const { return exec::num_blocks(world_); }
  uint32_t warps_per_block() const { return exec::warps_per_block(world_); }
  uint32_t num_warps() const { return num_blocks() * warps_per_block(); }

  // These start blocks and warps as launch.h says.
  void start(Block& block, uint32_t index) const { start_block(world_, block, index); }
  void start(WarpContext& warp, Block& block, uint32_t warp_in_block, const Seat& seat = {}) const {
    start_warp(world_, warp, block, warp_in_block, seat);
  }
  // Puts warp `warp_index` of a launch without blocks into `warp`, as a block of its own.
  void start(WarpContext& warp, uint32_t warp_index) const;

  // Returns the instruction that execute() would run next.
  const isa::Inst& next(const WarpContext& warp) const { return world_.image->code[warp.simt.pc].inst; }
  const isa::OpRow& next_row(const WarpContext& warp) const { return *world_.image->code[warp.simt.pc].row; }

  // Runs one instruction to its end. There are two exceptions. rt.trace, rt.resume and rq.proceed leave
  // `warp.waiting_for_rays` set: the machine traverses warp.rays[lane] for the lanes that are Traversing,
  // then calls finish_rays(). With World::traversal they call its program instead, like a shader, and no lane
  // that waits is Traversing. A bar.* that has to wait leaves `warp.waiting_at_barrier` set: the warp may be
  // executed again when another warp of its block has come or ended, and has cleared it. An mbarrier.*_wait
  // leaves in `warp.waits_for_phase` whether a phase has not ended, and the warp may be executed again.
  Issued execute(WarpContext& warp, Cycle now) {
    const uint32_t pc = warp.simt.pc;
    const Step& step = world_.image->code[pc];
    const LaneMask exec = lanes_at(warp, pc);
    warp.regs.exec = exec;
    Issued issued{pc, &step.inst, step.row, exec, warp.simt.active, false};
    if (!step.is_value || reads_clock_) [[unlikely]] {
      execute_effect(warp, issued, now);
      return issued;
    }
    step.run(warp.regs, step.inst, *step.row);
    ++warp.simt.pc;
    ++warp.instructions;
    retired.fire([&] { return Retired{warp, issued}; });
    return issued;
  }
  // Returns the lanes that the instruction at `pc` will be executed for: active, and let through by its
  // guard.
  LaneMask lanes_at(const WarpContext& warp, uint32_t pc) const {
    const isa::Inst& inst = world_.image->code[pc].inst;
    if (inst.guard == isa::kNoGuard) [[likely]]
      return warp.simt.active;
    const LaneMask guard = warp.regs.predicate[inst.guard & (isa::kNumPredicates - 1)];
    return warp.simt.active & (inst.guard & isa::kGuardNegate ? ~guard : guard);
  }
  // Does what execute() does for an instruction without an effect, when no shader reads the clock: for the
  // one at `pc`, which the warp has left already, and for `lanes`, which lanes_at() has returned.
  void execute_value(WarpContext& warp, uint32_t pc, LaneMask lanes) {
    const Step& step = world_.image->code[pc];
    warp.regs.exec = lanes;
    ++warp.instructions;
    step.run(warp.regs, step.inst, *step.row);
    if (retired.has_listeners()) [[unlikely]]
      tell_retired(warp, {pc, &step.inst, step.row, lanes, warp.simt.active, false});
  }
  // Returns whether some shader reads the clock, so that execute() has more to do.
  bool has_clock() const { return reads_clock_; }
  // Brings what execute() needs first near to the host's core.
  void prefetch(const WarpContext& warp) const { __builtin_prefetch(&world_.image->code[warp.simt.pc]); }
  // Writes the answer predicate of the rays that the warp waits for.
  void finish_rays(WarpContext& warp) const { rays_.finish(warp); }

  // Goes on with lanes that wait when the machine has moved the last running thread out of the warp. Returns
  // whether the warp has ended, because it has no more threads.
  bool resume(WarpContext& warp);
  // Returns what lanes said in the last *.reorder.
  const ReorderCalls& reorder_calls() const { return reorder_calls_; }

  // Returns the fault of an execute(). The warp is left as it was before the instruction.
  const std::optional<Fault>& fault() const { return faults_.fault(); }
  // Returns what went wrong and was let pass, because World::on_fault says so.
  const FaultLog& passed() const { return faults_.passed(); }

  const CandidateCounts& candidates() const { return candidate_counts_; }
  // Returns the number of lanes that have begun a shader of the stage because another shader called it.
  uint64_t called_lanes(isa::Stage stage) const { return calls_.called_lanes(stage); }

  // Returns the texels of the last texture or surface op, or none when it needed no memory.
  const TexelList& texels() const { return images_.texels(); }
  // Returns the stores of texels that were not finite.
  const NotFiniteStores& not_finite_stores() const { return images_.not_finite_stores(); }
  // Returns the lanes whose access the last load, store or atomic made in that space.
  LaneMask lanes_in(isa::Space space) const { return memory_.lanes_in(space); }

  // Returns the shared addresses to which the lanes of the last cp.async copied.
  const isa::Access& copied_to() const { return memory_.copied_to(); }
  // These belong to a machine in which copies take time. It calls let_arrive_late() first. Then
  // cp.async.mbarrier.arrive only leaves the places of the barriers in warp.regs.access, and arrive_late()
  // arrives there when the thread's copies are done. It returns false after a fault.
  void let_arrive_late() { memory_.let_arrive_late(); }
  bool arrive_late(WarpContext& warp, uint32_t pc, const isa::Access& places, LaneMask lanes) {
    return memory_.arrive_late(warp, pc, places, lanes);
  }
  // Asks again what a mbarrier.try_wait at `pc` asked, after which the warp has executed nothing, and returns
  // whether all of its phases have ended.
  bool ask_again(WarpContext& warp, uint32_t pc, LaneMask lanes) {
    const Step& step = world_.image->code[pc];
    return memory_.ask_again(warp, step.inst, *step.row, lanes);
  }

  // Reaches global memory through `view` from now on. Without a view, effects on it happen at once.
  void use(MemoryView* view) { seen_.use(view); }
  // Reaches global memory as a block does that runs before its turn.
  void use(BlockMemory* block) { seen_.use(block); }
  // Returns whether the last load or atomic writes its registers only when the view is committed.
  bool is_late() const { return seen_.is_late(); }
  // Returns a number that grows with every store outside of a view, and with every atomic outside of a view
  // that has changed something. Most of these are in shared memory.
  uint64_t changes() const { return memory_.changes(); }

  const World& world() const { return world_; }

 private:
  void tell_retired(const WarpContext& warp, const Issued& issued) const;
  void execute_effect(WarpContext& warp, Issued& issued, Cycle now);
  bool dispatch(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  bool is_in_trace(WarpContext& warp, const isa::OpRow& row);

  const World& world_;
  const bool reads_clock_;  // Some shader does, so its rows are filled before each instruction.
  const double clock_mhz_;
  CandidateCounts candidate_counts_;
  FaultGate faults_;
  RayFaults ray_faults_;
  SeenMemory seen_;
  MemoryOps memory_;
  ImageOps images_;
  Candidates candidates_;
  ShaderCalls calls_;
  Rays rays_;
  RayQueries queries_;
  HitObjects hit_objects_;
  ReorderCalls reorder_calls_;
  CodeTraversal traversal_;
  Control control_;
  Barriers barriers_;
};

}  // namespace glint::exec
