// Spills, fills and restarts the stacks of the RT unit's rays.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/stack_mover.h"

#include <utility>

namespace glint::rt {

StackMover::StackMover(std::unique_ptr<StackModel> model, Address stacks, mem::L1Port& l1, WarpBuffer& buffer,
                       FetchQueue& fetches, RayWalk& walk, RtStats& stats)
    : model_(std::move(model)),
      layout_{stacks, model_->rows()},
      l1_(l1),
      buffer_(buffer),
      fetches_(fetches),
      walk_(walk),
      stats_(stats),
      work_(buffer.size()) {
  if (const SharedArea area = model_->shared_area(); area.rows) shared_.emplace(area, &stats);
}

// A helper's entries lie in the room of its own lane.
void StackMover::ask_shared(Shared::Kind kind, uint32_t slot, int lane, uint16_t row, Cycle now) {
  const BufferSlot& at = buffer_[slot];
  shared_->ask({slot, row, uint8_t(lane), kind}, at.threads ? at.threads[lane].lane : lane, now);
}

void StackMover::move_shared(Cycle now) {
  shared_->run(now, [&](const Shared::Move& move) {
    if (move.kind == Shared::Kind::Store) return buffer_.write_sent(move.slot, now);
    if (move.kind == Shared::Kind::Load) return walk_.go_on(move.slot, move.lane, now);
    moves_.push({move.slot, move.row, move.lane, false});
  });
}

// A lane does not wait for what leaves the chip. A row that spills makes room in shared memory for the one
// that is stored next.
void StackMover::leave_chip(uint32_t slot, int lane, Cycle now) {
  StackWork& work = work_of(slot, lane);
  buffer_.add_writes(slot, uint32_t{work.spills} + work.stores);
  for (; work.stores; --work.stores) {
    if (work.spills == work.stores) {
      ask_shared(Shared::Kind::Spill, slot, lane, work.row++, now);
      --work.spills;
    }
    ask_shared(Shared::Kind::Store, slot, lane, work.shared_row++, now);
  }
  for (; work.spills; --work.spills) moves_.push({slot, work.row++, uint8_t(lane), false});
}

void StackMover::entered(uint32_t slot, int lane, Cycle) {
  work_of(slot, lane) = model_->settle(buffer_[slot].ray_of(lane));
}

void StackMover::visited(const Visit& visit) {
  work_of(visit.slot, visit.lane) = model_->settle(visit.ray);
}

// A lane waits for its loads, its fills and repeated visits, which follow one another.
bool StackMover::detour(uint32_t slot, int lane, Cycle now) {
  StackWork& work = work_of(slot, lane);
  if (work.spills + work.stores) leave_chip(slot, lane, now);
  if (work.loads) {
    --work.loads;
    ask_shared(Shared::Kind::Load, slot, lane, --work.shared_row, now);
    return true;
  }
  if (work.fills) {
    --work.fills;
    moves_.push({slot, --work.row, uint8_t(lane), true});
    return true;
  }
  if (work.replayed == work.replays) return false;
  if (work.replayed == 0) ++stats_.restarts;
  const Fetch& node = buffer_[slot].ray_of(lane).path->node[work.replayed++];
  buffer_.want(slot, lane, node, pipe_of(node.kind), this);
  return true;
}

// A node is visited again on the way down from the root.
void StackMover::errand_started(uint32_t, int) {
  ++stats_.restart_nodes;
}

bool StackMover::has_request(Cycle now) const {
  if (moves_.empty()) return false;
  const Move& move = moves_.front();
  return buffer_[move.slot].arrived < now && !(move.is_fill && fetches_.is_full());
}

Cycle StackMover::next_event(Cycle now) const {
  if (has_request(now) || (!fetches_.is_full() && has_reads_waiting())) return now + 1;
  return shared_ ? shared_->next_event(now) : kNever;
}

bool StackMover::send(Cycle now) {
  const Move move = moves_.front();
  const Thread thread = buffer_[move.slot].thread_of(move.lane);
  const Address at = layout_.sector(thread.warp_slot, move.row, thread.lane),
                offset = at & (l1_.line_bytes() - 1);
  mem::Request request;
  request.line = at - offset;
  request.sectors = uint8_t(1u << offset / mem::kSectorBytes);
  request.write = !move.is_fill;
  request.traffic = mem::Traffic::RtStack;
  if (move.is_fill) request.token = fetches_.open(move.slot, move.lane);
  if (!l1_.access(now, mem::Client::RtUnit, request)) {
    if (move.is_fill) fetches_.cancel(request.token);
    return false;
  }
  moves_.pop();
  if (move.is_fill) {
    ++stats_.stack_fills;
  } else {
    ++stats_.stack_spills;
    buffer_.write_sent(move.slot, now);
  }
  return true;
}

}  // namespace glint::rt
