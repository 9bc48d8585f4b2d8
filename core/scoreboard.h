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
    entries_.fill({});
    held_.fill(0);
  }
  // Returns when all of `registers` are ready. It is not before `start`, which waits for `start.wait`.
  Ready ready(std::span<const uint16_t> registers, Ready start) const {
    for (uint16_t r : registers) start = later(start, {entries_[r].ready, entries_[r].wait});
    return start;
  }
  // Does the same when results reach other pipes `crossing` cycles later than their own and guards `guard`
  // cycles later, and when the instruction's own results may come `slack` cycles after those that it waits
  // for.
  Ready ready(std::span<const uint16_t> registers, Ready start, const IssueRow& row, Cycle crossing,
              Cycle guard, Cycle slack) const {
    const size_t guard_at = row.is_guarded ? size_t(row.num_uses - row.num_defs - 1) : registers.size();
    for (size_t i = 0; i < registers.size(); ++i) {
      const Entry& entry = entries_[registers[i]];
      if (entry.ready == 0) continue;
      const bool is_source = i < size_t(row.num_uses - row.num_defs);
      const bool crosses = entry.from != Pipe::Count && entry.from != row.pipe && is_source;
      const Cycle delay = i == guard_at ? guard : crosses ? crossing : 0;
      const Cycle at = entry.ready == kNever ? kNever : before(entry.ready + delay, is_source ? 0 : slack);
      start = later(start, {at, entry.wait});
    }
    return start;
  }
  // Does the same for an instruction whose results come `latency` cycles after its issue. Earlier results of
  // its registers only have to come before these.
  Ready ready_in_order(std::span<const uint16_t> sources, std::span<const uint16_t> results, Ready start,
                       Cycle latency) const {
    start = ready(sources, start);
    for (uint16_t r : results)
      start = later(start, {before(entries_[r].ready, latency - 1), entries_[r].wait});
    return start;
  }
  // Returns when all of `registers` have been read by the instructions that hold them.
  Ready unread(std::span<const uint16_t> registers, Ready start) const {
    for (uint16_t r : registers) {
      const Cycle at = entries_[r].readers ? kNever : held_[r];
      start = later(start, {at, Stall::OperandRead});
    }
    return start;
  }
  void hold(std::span<const uint16_t> registers) {
    for (uint16_t r : registers) ++entries_[r].readers;
  }
  // Notes that an instruction which holds the registers reads them until `end`.
  void read(std::span<const uint16_t> registers, Cycle end) {
    for (uint16_t r : registers) {
      --entries_[r].readers;
      held_[r] = std::max(held_[r], end);
    }
  }
  // Sets the ready time. `from` is the pipe whose result it is. Count stands for a result that reaches all
  // pipes at the same time.
  void set(std::span<const uint16_t> registers, Ready value, Pipe from = Pipe::Count) {
    for (uint16_t r : registers) {
      Entry& entry = entries_[r];
      entry.ready = value.at;
      entry.wait = value.wait;
      entry.from = from;
    }
  }

 private:
  // Returns the later of two, the first if they are equal. There is no branch, because which of an
  // instruction's registers comes last cannot be foreseen.
  static Ready later(const Ready& first, const Ready& second) {
    const bool takes_second = second.at > first.at;
    return {takes_second ? second.at : first.at, takes_second ? second.wait : first.wait};
  }
  static Cycle before(Cycle at, Cycle cycles) {
    return at == kNever ? kNever : std::max(at, cycles) - cycles;
  }

  // What is needed of a register lies together, because an instruction looks at few registers.
  struct Entry {
    Cycle ready = 0;
    Stall wait = Stall::RawFixed;
    Pipe from = Pipe::Count;
    uint16_t readers = 0;  // memory instructions that have not read the register yet
  };
  static_assert(sizeof(Entry) == 16);

  std::array<Entry, kScoreboardEntries> entries_{};
  std::array<Cycle, kScoreboardEntries> held_{};  // held until then by instructions that are reading it
};

}  // namespace glint::core
