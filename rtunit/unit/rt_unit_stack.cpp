// What an RT unit does for its rays' stacks: spills, fills, and restarts from the root.
// SPDX-License-Identifier: Apache-2.0
#include "base/check.h"
#include "rtunit/unit/rt_unit.h"

namespace glint::rt {

// Model: a ray that a second ray of its lane has overtaken while it waited for a shader (a ray query in an
// any-hit shader) loses its path; the rest of its stack then counts as on chip.
void RtUnit::keep_path(RayState& state, uint32_t warp_slot, int lane) {
  if (paths_.size() <= warp_slot) paths_.resize(warp_slot + 1);
  if (!paths_[warp_slot]) paths_[warp_slot] = std::make_unique<std::array<RayPath, kLanes>>();
  RayPath& path = (*paths_[warp_slot])[size_t(lane)];
  if (state.nodes_visited == 0) {
    GLINT_DCHECK(state.stack_size == 1, "a new ray has {} nodes to visit", state.stack_size);
    path.ray = &state;
    path.depth = path.parent[0] = RayPath::kNoParent;
    state.path = &path;
  } else if (state.path != &path || path.ray != &state) {
    state.path = nullptr;
    state.stack_off_chip = 0;
  }
}

// Does the next of what the stack model asks for; true: the lane goes on when that has been done.
bool RtUnit::tend_stack(uint32_t slot_index, int lane) {
  Slot& slot = slots_[slot_index];
  StackWork& work = slot.stack[size_t(lane)];
  for (; work.spills; --work.spills, ++slot.spills)
    stack_ops_.push({slot_index, work.row++, uint8_t(lane), false});
  if (work.fills) {
    --work.fills;
    stack_ops_.push({slot_index, --work.row, uint8_t(lane), true});
    return true;
  }
  if (work.replayed == work.replays) return false;
  if (work.replayed == 0) ++stats_.restarts;
  slot.node[size_t(lane)] = slot.states[lane].path->node[work.replayed++];
  slot.part[size_t(lane)] = Part::Replay;
  slot.wanting |= LaneMask{1} << lane;
  return true;
}

bool RtUnit::can_send_stack(Cycle now) const {
  if (stack_ops_.empty()) return false;
  const StackOp& op = stack_ops_.front();
  return slots_[op.slot].arrived < now && !(op.is_fill && is_mshr_full());
}

// Model: a sector at a time; lanes do not share requests.
bool RtUnit::send_stack(Cycle now) {
  const StackOp op = stack_ops_.front();
  Slot& slot = slots_[op.slot];
  const Address at = stacks_.sector(slot.warp, op.row, op.lane), offset = at & (l1_.line_bytes() - 1);
  mem::Request request;
  request.line = at - offset;
  request.sectors = uint8_t(1u << offset / mem::kSectorBytes);
  request.write = !op.is_fill;
  request.traffic = mem::Traffic::RtStack;
  request.token = free_fetches_.back();
  if (!l1_.access(now, mem::Client::RtUnit, request)) return false;
  stack_ops_.pop();
  if (op.is_fill) {
    ++stats_.stack_fills;
    ++num_fetches_;
    NodeFetch& fetch = fetches_[new_fetch(op.slot, LaneMask{1} << op.lane, {}, Part::Fill)];
    fetch.unanswered = 1;
    return true;
  }
  ++stats_.stack_spills;
  --slot.spills;
  leave(op.slot, now);
  return true;
}

}  // namespace glint::rt
