// The load-store unit of a core.
// SPDX-License-Identifier: Apache-2.0
#include "core/lsu.h"

#include <algorithm>
#include <bit>

#include "base/check.h"

namespace glint::core {

Lsu::Lsu(const Params& params, mem::L1Port& l1)
    : l1_(l1), params_(params.lsu), shared_(params.shared), lsu_unit_(params.units.lsu), tex_unit_(params.units.tex),
      num_queues_(params.schedulers), queue_capacity_(params.lsu.queue),
      accesses_(params.lsu.accesses, MemoryAccess(l1.line_bytes())) {
  for (Pipe& pipe : pipes_) pipe.id.resize(accesses_.size());
  for (uint32_t id = uint32_t(accesses_.size()); id-- > 0;) free_.push_back(id);
  completed_.reserve(accesses_.size());
}

MemoryAccess& Lsu::take(uint32_t scheduler, Cycle now) {
  GLINT_DCHECK(can_take(scheduler), "scheduler {} has no room for an access", scheduler);
  Queue& queue = queues_[scheduler];
  const uint32_t id = free_.back();
  free_.pop_back();
  queue.id[(queue.head + queue.count++) % kMaxQueue] = id;
  MemoryAccess& access = accesses_[id];
  access.lines.clear();
  access.num_sent = access.num_answers = access.passes = access.num_table_lines = 0;
  access.atomic = false;
  access.bank_turns = 1;
  access.issued = now;
  access.late_until = 0;
  return access;
}

void Lsu::tick(Cycle now) {
  completed_.clear();
  take_answers(now);
  accept(now);
  send(now);
}

void Lsu::take_answers(Cycle now) {
  while (const auto token = l1_.pop(now, mem::Client::Lsu)) {
    MemoryAccess& access = accesses_[*token];
    ++access.num_answers;
    if (access.num_answers == access.lines.lines().size()) completed_.push_back(*token);
  }
}

// Round robin over the schedulers' queues, one access in accept_interval cycles.
void Lsu::accept(Cycle now) {
  if (now < accept_at_) return;
  for (uint32_t i = 0; i < num_queues_; ++i) {
    const uint32_t q = (next_queue_ + i) % num_queues_;
    Queue& queue = queues_[q];
    if (queue.count == 0 || now < queue.free_at) continue;
    const uint32_t id = queue.id[queue.head];
    MemoryAccess& access = accesses_[id];
    Pipe& pipe = pipes_[pipe_of(access)];
    if (access.issued >= now || now < pipe.free_at) continue;
    queue.head = (queue.head + 1) % kMaxQueue;
    --queue.count;
    ++num_vacated_;
    queue.free_at = now + lsu_unit_.interval;
    // The cycle between issue and here is the first of the latency, so that an unloaded unit adds just that.
    access.ready = now - 1 + (access.texture ? tex_unit_ : lsu_unit_).latency;
    if (access.texture) pipe.free_at = now + tex_unit_.interval;
    const uint32_t tag_cycles = uint32_t(access.lines.lines().size() + params_.lines_per_cycle - 1) / params_.lines_per_cycle;
    access.hold = access.bank_turns > tag_cycles ? access.bank_turns - tag_cycles : 0;
    if (access.bank_turns > 1) access.ready += std::max<Cycle>(conflict_latency(access.bank_turns - 1), access.hold) - access.hold;
    if (access.passes > 0) {
      const Cycle more = shared_cycles(access) - 1;
      if (&pipe == &pipes_[kShared]) access.ready = now - 1 + (access.atomic ? shared_.atomic_latency : shared_.latency);
      access.ready += access.atomic ? more : conflict_latency(more);
      pipe.free_at = now + 1 + more;
    }
    pipe.id[(pipe.head + pipe.count++) % pipe.id.size()] = id;
    accept_at_ = now + params_.accept_interval;
    next_queue_ = (q + 1) % num_queues_;
    return;
  }
}

Cycle Lsu::shared_cycles(const MemoryAccess& access) const {
  return access.atomic ? 1 + (access.passes - 1) * Cycle{shared_.atomic_pass} : access.passes;
}

void Lsu::pop(Pipe& pipe) {
  pipe.head = uint32_t((pipe.head + 1) % pipe.id.size());
  --pipe.count;
}

void Lsu::finish_shared(Cycle now) {
  Pipe& pipe = pipes_[kShared];
  for (; pipe.count > 0 && accesses_[pipe.front()].ready <= now; pop(pipe)) completed_.push_back(pipe.front());
}

// Lines of one access a cycle; the pipe not served last goes first.
void Lsu::send(Cycle now) {
  finish_shared(now);
  if (now < port_free_) return;
  for (uint32_t i = 0; i < 2; ++i) {
    const uint32_t p = (next_pipe_ + i) % 2;
    if (pipes_[p].count > 0 && accesses_[pipes_[p].front()].ready <= now && send_line(now, pipes_[p])) {
      next_pipe_ = 1 - p;
      return;
    }
  }
}

bool Lsu::send_line(Cycle now, Pipe& pipe) {
  const uint32_t id = pipe.front();
  MemoryAccess& access = accesses_[id];
  const auto lines = access.lines.lines();
  if (access.hold > 0) {
    port_free_ = access.ready = now + access.hold;
    access.hold = 0;
    return true;
  }
  uint32_t cycles = 0;
  for (uint32_t n = 0; n < params_.lines_per_cycle && access.num_sent < lines.size(); ++n) {
    const LineSectors& line = lines[access.num_sent];
    const mem::Traffic traffic = access.num_sent < access.num_table_lines ? mem::Traffic::RtTable : access.traffic;
    if (!l1_.access(now, mem::Client::Lsu, {line.line, line.sectors, access.write, traffic, id})) break;
    ++access.num_sent;
    cycles = std::max(cycles, (uint32_t(std::popcount(line.sectors)) + params_.sectors_per_cycle - 1) / params_.sectors_per_cycle);
  }
  if (cycles == 0) return false;
  port_free_ = now + cycles;
  if (access.num_sent == lines.size()) {
    pop(pipe);
    if (access.write) completed_.push_back(id);
  }
  return true;
}

Cycle Lsu::next_event(Cycle now) const {
  Cycle next = kNever;
  for (const Pipe& pipe : pipes_)
    if (pipe.count > 0) next = std::min(next, std::max(accesses_[pipe.front()].ready, &pipe == &pipes_[kShared] ? 0 : port_free_));
  for (uint32_t q = 0; q < num_queues_; ++q) {
    const Queue& queue = queues_[q];
    if (queue.count == 0) continue;
    const MemoryAccess& access = accesses_[queue.id[queue.head]];
    next = std::min(next, std::max({queue.free_at, access.issued + 1, accept_at_, pipes_[pipe_of(access)].free_at}));
  }
  return next == kNever ? kNever : std::max(next, now + 1);
}

}  // namespace glint::core
