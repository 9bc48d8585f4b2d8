// Implements the load-store unit of a core.
// SPDX-License-Identifier: Apache-2.0
#include "core/lsu.h"

#include <algorithm>
#include <bit>
#include <memory>

#include "base/check.h"

namespace glint::core {

Lsu::Lsu(const Params& params, mem::L1Port& l1)
    : l1_(l1),
      params_(params.lsu),
      shared_(params.shared),
      lsu_unit_(params.units.lsu),
      tex_unit_(params.units.tex),
      samples_per_cycle_(params.texture.samples_per_cycle),
      own_queue_(params.texture.queue > 0),
      own_door_(params.texture.own_door),
      accesses_(params.lsu.accesses, mem::Filling::Sparse) {
  groups_[0].capacity = params.lsu.queue;
  groups_[1].capacity = params.texture.queue;
  for (uint32_t sectors = 0; sectors < sector_cycles_.size(); ++sectors)
    sector_cycles_[sectors] = uint8_t((sectors + params_.sectors_per_cycle - 1) / params_.sectors_per_cycle);
  for (uint32_t id = uint32_t(accesses_.size()); id-- > 0;) free_.push_back(id);
  completed_.reserve(accesses_.size());
  if (params_.merged_lines) waiting_store_.assign(params.warps + params.parking_lot.warps, kNoStore);
}

MemoryAccess& Lsu::take(uint32_t scheduler, Cycle now, bool texture) {
  GLINT_DCHECK(can_take(scheduler, texture), "scheduler {} has no room for an access", scheduler);
  Group& group = groups_[texture && own_queue_];
  Queue& queue = group.queues[scheduler];
  group.filled |= 1u << scheduler;
  const uint32_t id = free_.back();
  free_.pop_back();
  queue.id[(queue.head + queue.count++) % kMaxQueue] = id;
  MemoryAccess& access = accesses_[id];
  if (id == num_made_) std::construct_at(&access, l1_.line_bytes()), ++num_made_;
  access.lines.clear();
  access.num_sent = access.num_answers = access.passes = access.num_table_lines = 0;
  access.atomic = access.is_of_matrices = false;
  access.texture = texture;
  access.samples = 0;
  access.bank_turns = 1;
  access.issued = now;
  access.late_until = 0;
  due_ = std::min(due_, now + 1);
  return access;
}

void Lsu::run(Cycle now) {
  if (l1_.has_answer(now, mem::Client::Lsu)) take_answers(now);
  if (now < due_) return;
  for (Group& group : groups_)
    if (group.filled) accept(group, now);
  send(now);
  due_ = find_due(now);
}

void Lsu::take_answers(Cycle now) {
  while (const auto token = l1_.pop(now, mem::Client::Lsu)) {
    MemoryAccess& access = accesses_[*token];
    ++access.num_answers;
    if (access.num_answers == access.lines.lines().size()) completed_.push_back(*token);
  }
}

// Takes one access in accept_interval cycles from the schedulers' queues, which take turns.
void Lsu::accept(Group& group, Cycle now) {
  if (now < group.accept_at || group.capacity == 0) return;
  const uint32_t first = group.filled >> group.next << group.next;  // The turn begins with these.
  for (const uint32_t part : {first, group.filled & ~first})
    for (uint32_t rest = part; rest; rest &= rest - 1)
      if (accept_from(group, uint32_t(std::countr_zero(rest)), now)) return;
}

bool Lsu::accept_from(Group& group, uint32_t q, Cycle now) {
  Queue& queue = group.queues[q];
  if (now < queue.free_at) return false;
  const uint32_t id = queue.id[queue.head];
  Pipe& pipe = pipes_[pipe_of(accesses_[id])];
  if (accesses_[id].issued >= now || now < pipe.free_at) return false;
  queue.head = (queue.head + 1) % kMaxQueue;
  if (--queue.count == 0) group.filled &= ~(1u << q);
  ++num_vacated_;
  queue.free_at = now + lsu_unit_.interval;
  group.accept_at = now + params_.accept_interval;
  group.next = q + 1;
  enter(id, pipe, now);
  return true;
}

// Puts an access at the end of its pipe.
void Lsu::enter(uint32_t id, Pipe& pipe, Cycle now) {
  MemoryAccess& access = accesses_[id];
  if (params_.merged_lines && access.write && merge(id)) {
    completed_.push_back(id);
    accepted_[num_accepted_++] = id;
    return;
  }
  // The cycle from issue to here is the first of the latency, so an unloaded unit adds exactly its latency.
  access.ready = now - 1 + (access.texture ? tex_unit_ : lsu_unit_).latency;
  if (access.texture) {
    const Cycle cycles = texture_cycles(access);
    pipe.free_at = now + std::max<Cycle>(tex_unit_.interval, cycles);
    access.ready += std::max<Cycle>(cycles, 1) - 1;
  }
  const uint32_t tag_cycles =
      uint32_t(access.lines.lines().size() + params_.lines_per_cycle - 1) / params_.lines_per_cycle;
  access.hold = access.bank_turns > tag_cycles ? access.bank_turns - tag_cycles : 0;
  if (access.bank_turns > 1)
    access.ready += std::max<Cycle>(conflict_latency(access.bank_turns - 1), access.hold) - access.hold;
  if (access.passes > 0) {
    const Cycle more = shared_cycles(access) - 1;
    const Cycle latency = shared_latency(access);
    if (&pipe == &pipes_[kShared])
      access.ready = now - 1 + latency;
    else
      access.ready += latency - (access.atomic ? shared_.atomic_latency : shared_.latency);
    pipe.free_at = now + 1 + more;
  }
  pipe.ids.push(id);
  accepted_[num_accepted_++] = id;
}

// Adds a store to the warp's store before it, and returns whether it could. Otherwise the store is the one
// that the next may be added to.
bool Lsu::merge(uint32_t id) {
  MemoryAccess& access = accesses_[id];
  if (access.traffic == mem::Traffic::ShaderAtomic) return false;
  uint32_t& waiting = waiting_store_[access.slot];
  const size_t lines = access.lines.lines().size();
  if (waiting != kNoStore && lines > 0 && lines <= params_.merged_lines &&
      accesses_[waiting].traffic == access.traffic && accesses_[waiting].lines.merge(access.lines))
    return true;
  if (lines > 0) waiting = id;
  return false;
}

// Returns the cycles of the texture units for the samples of an access, or 0 when only the interval counts.
Cycle Lsu::texture_cycles(const MemoryAccess& access) const {
  return samples_per_cycle_ ? (access.samples + samples_per_cycle_ - 1) / samples_per_cycle_ : 0;
}

Cycle Lsu::shared_cycles(const MemoryAccess& access) const {
  return access.atomic && !access.merges_lanes ? 1 + (access.passes - 1) * Cycle{shared_.atomic_interval}
                                               : access.passes;
}

// Returns the latency in shared memory. Model: turns of a compare-and-swap or a floating-point addition keep
// the unit busy no longer than those of an integer atomic, because their extra time lies between their
// accesses.
Cycle Lsu::shared_latency(const MemoryAccess& access) const {
  // Further passes of matrices are hidden by nothing: x1, x2 and x4 take 23, 25 and 29 cycles on an H200.
  if (access.is_of_matrices) return shared_.latency + (access.passes - 1) * Cycle{shared_.conflict_turn};
  if (!access.atomic) return shared_.latency + conflict_latency(access.passes - 1);
  const AtomicParams& own = access.atomic_kind == isa::AtomicKind::Swap ? shared_.swap : shared_.float_add;
  const bool is_own = access.atomic_kind != isa::AtomicKind::Integer && own.latency > 0;
  const AtomicParams times =
      is_own ? own : AtomicParams{shared_.atomic_latency, shared_.atomic_pass, shared_.atomic_hidden};
  return times.latency + std::max((access.passes - 1) * times.pass, times.hidden) - times.hidden;
}

void Lsu::finish_shared(Cycle now) {
  Pipe& pipe = pipes_[kShared];
  for (; !pipe.ids.empty() && accesses_[pipe.ids.front()].ready <= now; pipe.ids.pop())
    completed_.push_back(pipe.ids.front());
}

// Sends lines of one access per cycle and door. The pipe that was not served last goes first.
void Lsu::send(Cycle now) {
  finish_shared(now);
  const uint32_t first = next_pipe_;
  for (uint32_t i = 0; i < 2; ++i) {
    const uint32_t p = (first + i) % 2;
    if (pipes_[p].ids.empty() || now < door_free_[door_of(p)] || accesses_[pipes_[p].ids.front()].ready > now)
      continue;
    if (send_line(now, p)) next_pipe_ = 1 - p;
  }
}

bool Lsu::send_line(Cycle now, size_t p) {
  Pipe& pipe = pipes_[p];
  Cycle& door_free = door_free_[door_of(p)];
  const uint32_t id = pipe.ids.front();
  MemoryAccess& access = accesses_[id];
  const auto lines = access.lines.lines();
  if (access.hold > 0) {
    door_free = access.ready = now + access.hold;
    access.hold = 0;
    return true;
  }
  uint32_t cycles = 0;
  for (uint32_t n = 0; n < params_.lines_per_cycle && access.num_sent < lines.size(); ++n) {
    const LineSectors& line = lines[access.num_sent];
    const mem::Traffic traffic =
        access.num_sent < access.num_table_lines ? mem::Traffic::RtTable : access.traffic;
    mem::AtomicLanes atomic = line.atomic();
    atomic.adds_floats = access.atomic_kind == isa::AtomicKind::FloatAdd;
    if (!l1_.access(now, mem::Client::Lsu,
                    {line.line, line.sectors, access.write, traffic, id, line.words, atomic}))
      break;
    ++access.num_sent;
    cycles = std::max<uint32_t>(cycles, sector_cycles_[mem::num_sectors(line.sectors)]);
  }
  if (cycles == 0) return false;
  if (params_.merged_lines && waiting_store_[access.slot] == id) waiting_store_[access.slot] = kNoStore;
  door_free = now + cycles;
  if (access.num_sent == lines.size()) {
    pipe.ids.pop();
    if (access.traffic == mem::Traffic::ShaderAtomic)
      door_free = now + std::max<Cycle>(cycles, params_.atomic_interval);
    if (access.write) completed_.push_back(id);
  }
  return true;
}

Cycle Lsu::find_due(Cycle now) const {
  Cycle next = kNever;
  for (size_t p = 0; p < pipes_.size(); ++p) {
    if (pipes_[p].ids.empty()) continue;
    const Cycle door = p == kShared ? 0 : door_free_[door_of(p)];
    next = std::min(next, std::max(accesses_[pipes_[p].ids.front()].ready, door));
  }
  for (const Group& group : groups_)
    for (uint32_t rest = group.filled; rest; rest &= rest - 1) {
      const Queue& queue = group.queues[size_t(std::countr_zero(rest))];
      const MemoryAccess& access = accesses_[queue.id[queue.head]];
      next = std::min(next, std::max({queue.free_at, access.issued + 1, group.accept_at,
                                      pipes_[pipe_of(access)].free_at}));
    }
  return next == kNever ? kNever : std::max(next, now + 1);
}

}  // namespace glint::core
