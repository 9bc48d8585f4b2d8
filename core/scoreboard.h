// Knows when each register and predicate of one warp can be read or overwritten.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "base/types.h"
#include "core/issue_table.h"
#include "core/stall.h"

namespace glint::core {

// Holds the ready times. An instruction issues when its sources are ready (read after write) and its
// destinations are, too (write after write: results of one register arrive in order). Write after read needs
// a check only for memory instructions, which read their registers when they leave their queue. Model:
// hardware of this kind leaves fixed latencies to stall counts that the compiler sets, and counts variable
// ones in six counters per warp. A ready time per register gives the same cycles when those are set well.
class Scoreboard {
 public:
  struct Ready {
    Cycle at = 0;                  // kNever: it is known when an access or the RT unit answers
    Stall wait = Stall::RawFixed;  // what the last of the registers waits for
  };

  void reset() {
    ready_.fill(0);
    wait_.fill(Stall::RawFixed);
    from_.fill(Pipe::Count);
    readers_.fill(0);
    held_.fill(0);
  }
  // Returns when all of `registers` are ready. It is not before `start`, which waits for `start.wait`.
  Ready ready(std::span<const uint16_t> registers, Ready start) const {
    for (uint16_t r : registers)
      if (ready_[r] > start.at) start = {ready_[r], wait_[r]};
    return start;
  }
  // Does the same when results reach other pipes `crossing` cycles later than their own and guards `guard`
  // cycles later, and when the instruction's own results may come `slack` cycles after those that it waits
  // for.
  Ready ready(std::span<const uint16_t> registers, Ready start, const IssueRow& row, Cycle crossing,
              Cycle guard, Cycle slack) const {
    const size_t guard_at = row.is_guarded ? size_t(row.num_uses - row.num_defs - 1) : registers.size();
    for (size_t i = 0; i < registers.size(); ++i) {
      const uint16_t r = registers[i];
      if (ready_[r] == 0) continue;
      const bool is_source = i < size_t(row.num_uses - row.num_defs);
      const bool crosses = from_[r] != Pipe::Count && from_[r] != row.pipe && is_source;
      const Cycle later = i == guard_at ? guard : crosses ? crossing : 0;
      const Cycle at = ready_[r] == kNever ? kNever : before(ready_[r] + later, is_source ? 0 : slack);
      if (at > start.at) start = {at, wait_[r]};
    }
    return start;
  }
  // Does the same for an instruction whose results come `latency` cycles after its issue. Earlier results of
  // its registers only have to come before these.
  Ready ready_in_order(std::span<const uint16_t> sources, std::span<const uint16_t> results, Ready start,
                       Cycle latency) const {
    start = ready(sources, start);
    for (uint16_t r : results) {
      const Cycle at = before(ready_[r], latency - 1);
      if (at > start.at) start = {at, wait_[r]};
    }
    return start;
  }
  // Returns when all of `registers` have been read by the instructions that hold them.
  Ready unread(std::span<const uint16_t> registers, Ready start) const {
    for (uint16_t r : registers) {
      const Cycle at = readers_[r] ? kNever : held_[r];
      if (at > start.at) start = {at, Stall::OperandRead};
    }
    return start;
  }
  void hold(std::span<const uint16_t> registers) {
    for (uint16_t r : registers) ++readers_[r];
  }
  // Notes that an instruction which holds the registers reads them until `end`.
  void read(std::span<const uint16_t> registers, Cycle end) {
    for (uint16_t r : registers) {
      --readers_[r];
      held_[r] = std::max(held_[r], end);
    }
  }
  // Sets the ready time. `from` is the pipe whose result it is. Count stands for a result that reaches all
  // pipes at the same time.
  void set(std::span<const uint16_t> registers, Ready value, Pipe from = Pipe::Count) {
    for (uint16_t r : registers) {
      ready_[r] = value.at;
      wait_[r] = value.wait;
      from_[r] = from;
    }
  }

 private:
  static Cycle before(Cycle at, Cycle cycles) {
    return at == kNever ? kNever : std::max(at, cycles) - cycles;
  }

  std::array<Cycle, kScoreboardEntries> ready_{};
  std::array<Stall, kScoreboardEntries> wait_{};
  std::array<Pipe, kScoreboardEntries> from_{};
  std::array<uint16_t, kScoreboardEntries> readers_{};  // memory instructions that have not read it yet
  std::array<Cycle, kScoreboardEntries> held_{};        // held until then by instructions that are reading it
};

}  // namespace glint::core
