// Reads hit objects, hints and the rays of a trace where threads may be moved.
// SPDX-License-Identifier: Apache-2.0
#include "exec/reorder_calls.h"

#include <algorithm>
#include <bit>

#include "exec/hit_records.h"
#include "exec/numbered.h"
#include "isa/hit_object.h"

namespace glint::exec {

using isa::HitObjectOp;
using Found = ReorderCall::Found;

bool ReorderCalls::run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  const LaneMask lanes = warp.regs.exec;
  if (lanes == 0) return ++warp.simt.pc, true;
  const int first = std::countr_zero(lanes);
  const auto op = HitObjectOp(row.detail);
  calls_.fill({});
  live_registers_ = 1;  // the stack pointer: what else is live has been saved before the trace
  stack_bytes_ = warp.regs.bank[0][isa::kStackPointer * kLanes + size_t(first)];
  if (op == HitObjectOp::ReorderByTrace) {
    if (warp.depth == 0)
      return faults_.fail(warp, first, "regroups lanes by what a trace has found, and none is open");
    read_trace(warp);
  } else {
    if (op == HitObjectOp::Reorder && !read_objects(warp, inst)) return false;
    const size_t hint = op == HitObjectOp::Reorder ? 1 : 0;
    read_hints(warp, inst, hint);
    live_registers_ = warp.regs.read(inst.operand[hint + 2])[first];
    stack_bytes_ += world_.image->shaders[world_.image->shader_of[warp.simt.pc]].local_bytes;
  }
  ++warp.simt.pc;
  return true;
}

bool ReorderCalls::read_objects(WarpContext& warp, const isa::Inst& inst) {
  const HitObject* const objects =
      find_numbered(faults_, warp, warp.hit_objects, inst.operand[0], warp.depth, "hit object");
  if (!objects) return false;
  for_each_lane(warp.regs.exec, [&](int lane) {
    const HitObject& object = objects[lane];
    ReorderCall& call = calls_[size_t(lane)];
    call.found = object.type == HitObject::Type::Hit    ? Found::Hit
                 : object.type == HitObject::Type::Miss ? Found::Miss
                                                        : Found::Nothing;
    call.record = object.record;
    if (call.found == Found::Nothing) return;
    call.ray = &object.ray;
    if (call.found == Found::Hit) call.hit = &object.hit;
  });
  return true;
}

void ReorderCalls::read_hints(const WarpContext& warp, const isa::Inst& inst, size_t operand) {
  const uint32_t *const hints = warp.regs.read(inst.operand[operand]), *const bits = warp.regs.read(
                                                                           inst.operand[operand + 1]);
  for_each_lane(warp.regs.exec, [&](int lane) {
    ReorderCall& call = calls_[size_t(lane)];
    call.bits = std::min(bits[lane], 32u);
    call.hint = call.bits == 32 ? hints[lane] : hints[lane] & ((1u << call.bits) - 1);
  });
}

void ReorderCalls::read_trace(const WarpContext& warp) {
  for_each_lane(warp.regs.exec, [&](int lane) {
    const rt::RayState& state = warp.ray(lane);
    ReorderCall& call = calls_[size_t(lane)];
    if (state.status == rt::RayStatus::Idle) {  // of a hit object that is empty
      call.found = Found::Nothing;
      return;
    }
    const bool is_hit = state.committed.valid();
    call.found = is_hit ? Found::Hit : Found::Miss;
    call.record = is_hit ? hit_record(world_, state.ray, state.committed)
                         : world_.table.miss.number(state.ray.miss_index);
    call.ray = &state.ray;
    if (is_hit) call.hit = &state.committed;
  });
}

}  // namespace glint::exec
