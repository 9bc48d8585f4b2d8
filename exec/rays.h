// Runs ray instructions: rt.*, which open and close traces and give rays to whoever walks them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "exec/candidates.h"
#include "exec/ray_faults.h"
#include "isa/op_row.h"

namespace glint::exec {

class Rays {
 public:
  Rays(const World& world, FaultGate& faults, RayFaults& ray_faults, Candidates& candidates)
      : world_(world), faults_(faults), ray_faults_(ray_faults), candidates_(candidates) {}

  // Returns false after a fault.
  bool run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);

  // Opens a level with the payloads and attributes of its lanes. No ray travels yet. `payload_operand` is the
  // operand of the payload, which that of the attributes follows. Returns false after a fault.
  bool open_trace(WarpContext& warp, const isa::Inst& inst, size_t payload_operand);
  // Ends the innermost level, and gives its lanes back their rays of the level below.
  static void close_trace(WarpContext& warp);
  // Lets the executing lanes wait for their `rays`, one per lane. `answer` is the predicate that they will
  // get.
  static void wait_for(WarpContext& warp, rt::RayState* rays, isa::Slot answer);
  // Writes the answer predicate of the rays that the warp has waited for, which says which lanes need a
  // shader.
  void finish(WarpContext& warp) const;

 private:
  bool trace(WarpContext& warp, const isa::Inst& inst);
  bool keep_outer_rays(WarpContext& warp, TraceFrame& frame);
  bool report(WarpContext& warp, const isa::Inst& inst);
  static void answer_accepted(WarpContext& warp, isa::Slot answer);

  const World& world_;
  FaultGate& faults_;
  RayFaults& ray_faults_;
  Candidates& candidates_;
};

}  // namespace glint::exec
