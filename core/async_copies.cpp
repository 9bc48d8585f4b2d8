// Follows the asynchronous copies of a core's warps, and what waits for them.
// SPDX-License-Identifier: Apache-2.0
#include "core/async_copies.h"

#include <algorithm>

#include "isa/async_copy.h"

namespace glint::core {

uint32_t CopyGroups::start() {
  ++count_[open_ % kGroups];
  return open_;
}

void CopyGroups::commit() {
  uint16_t& count = count_[++open_ % kGroups];
  older_ += count;
  count = 0;
}

void CopyGroups::end(uint32_t group) {
  if (open_ - group < kGroups)
    --count_[group % kGroups];
  else
    --older_;
}

uint32_t CopyGroups::num_before(uint32_t but) const {
  uint32_t sum = older_;
  for (uint32_t age = but + 1; age < kGroups && age != 0; ++age) sum += count_[(open_ - age) % kGroups];
  return sum;
}

std::unique_ptr<AsyncCopies> AsyncCopies::make(const CoreParts& core, MbarrierUnit* barriers,
                                               uint32_t accesses) {
  const auto& code = core.world.image->code;
  for (uint32_t pc = 0; pc < code.size(); ++pc)
    if (core.table.row(pc).is_copy || core.table.row(pc).finish == Finish::Copies)
      return std::make_unique<AsyncCopies>(core, barriers, accesses);
  return nullptr;
}

AsyncCopies::AsyncCopies(const CoreParts& core, MbarrierUnit* barriers, uint32_t accesses)
    : core_(core), barriers_(barriers), slots_(core.warps.size()), accesses_(accesses) {
  core.executor.let_arrive_late();
  late_.reserve(accesses);
  ended_.reserve(accesses);
}

void AsyncCopies::start(uint32_t slot, uint32_t id, const exec::Issued& issued) {
  Slot& at = slots_[slot];
  Access& access = accesses_[id];
  access.slot = slot;
  access.number = num_issued_++;
  access.is_copy = issued.row->effect == isa::Effect::Copy;
  if (access.is_copy) {
    access.group = at.groups.start();
    ++at.under_way;
    return;
  }
  access.pc = issued.pc;
  access.left = at.under_way;
  access.is_through = false;
  access.lanes = core_.executor.lanes_in(isa::Space::Shared);
  access.places = core_.warps[slot].warp.regs.access;
  access.next = at.arrivals;
  at.arrivals = id;
}

void AsyncCopies::order(uint32_t slot, const IssueRow& row, const exec::Issued& issued, Cycle now) {
  Slot& at = slots_[slot];
  WarpSlot& warp = core_.warps[slot];
  if (issued.lanes == 0) return;
  if (isa::CopyGroupKind(issued.row->detail) == isa::CopyGroupKind::Commit) return at.groups.commit();
  const uint32_t but = warp.warp.regs.read(issued.inst->operand[0])[0];
  const bool waits = at.groups.num_before(but) > 0;
  at.but = waits ? but : kNone;
  at.latency = row.latency;
  warp.front = {waits ? kNever : now + row.latency, row.wait};
}

bool AsyncCopies::end(uint32_t id, Cycle late_until, Cycle now) {
  Access& access = accesses_[id];
  if (!access.is_copy) {
    access.is_through = true;
    if (access.left > 0) return false;
    arrive(id, now);
  } else if (late_until > now) {
    late_.push_back({id, late_until});
    return false;
  } else {
    end_copy(access, now);
  }
  return true;
}

// Tells those who wait for the copy. Copies that were issued behind an arrival do not concern it.
void AsyncCopies::end_copy(const Access& copy, Cycle now) {
  Slot& at = slots_[copy.slot];
  at.groups.end(copy.group);
  --at.under_way;
  for (uint32_t id = at.arrivals, next = kNone; id != kNone; id = next) {
    Access& arrival = accesses_[id];
    next = arrival.next;
    if (arrival.number < copy.number || --arrival.left > 0 || !arrival.is_through) continue;
    arrive(id, now);
    ended_.push_back(id);
  }
  if (at.but == kNone || at.groups.num_before(at.but) > 0) return;
  at.but = kNone;
  core_.warps[copy.slot].front.at = now + at.latency;
}

void AsyncCopies::arrive(uint32_t id, Cycle now) {
  const Access& access = accesses_[id];
  uint32_t* link = &slots_[access.slot].arrivals;
  while (*link != id) link = &accesses_[*link].next;
  *link = access.next;
  exec::WarpContext& warp = core_.warps[access.slot].warp;
  if (core_.executor.arrive_late(warp, access.pc, access.places, access.lanes) && barriers_)
    barriers_->look(*warp.block, now);
}

std::optional<uint32_t> AsyncCopies::take_ended() {
  if (ended_.empty()) return {};
  const uint32_t id = ended_.back();
  ended_.pop_back();
  return id;
}

std::optional<uint32_t> AsyncCopies::due(Cycle now) {
  const auto at = std::find_if(late_.begin(), late_.end(), [&](const Late& late) { return late.at <= now; });
  if (at == late_.end()) return {};
  const uint32_t id = at->id;
  late_.erase(at);
  return id;
}

Cycle AsyncCopies::next_event() const {
  Cycle next = kNever;
  for (const Late& late : late_) next = std::min(next, late.at);
  return next;
}

}  // namespace glint::core
