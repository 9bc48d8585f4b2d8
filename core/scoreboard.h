// When each register and predicate of one warp can be read or overwritten.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>

#include "base/types.h"
#include "core/stall.h"
#include "core/units.h"

namespace glint::core {

// An instruction issues when its sources are ready (read after write) and its destinations are too (write after
// write: results of one register arrive in order). Write after read needs no check: operands are read at issue.
// Model: hardware of this kind leaves fixed latencies to stall counts that the compiler sets, and counts variable
// ones in six counters a warp; a ready time a register gives the same cycles when those are set well.
class Scoreboard {
 public:
  struct Ready {
    Cycle at = 0;                     // kNever: when an access or the RT unit answers
    Stall wait = Stall::RawFixed;     // what the last of the registers waits for
  };

  void reset() {
    ready_.fill(0);
    wait_.fill(Stall::RawFixed);
    from_.fill(Pipe::Count);
  }
  // When all of `registers` are ready; not before `start`, which waits for `start.wait`.
  Ready ready(std::span<const uint16_t> registers, Ready start) const {
    for (uint16_t r : registers)
      if (ready_[r] > start.at) start = {ready_[r], wait_[r]};
    return start;
  }
  // The same where results reach other pipes `crossing` cycles later than their own, and guards `guard` cycles later.
  Ready ready(std::span<const uint16_t> registers, Ready start, const IssueRow& row, Cycle crossing, Cycle guard) const {
    const size_t guard_at = row.is_guarded ? size_t(row.num_uses - row.num_defs - 1) : registers.size();
    for (size_t i = 0; i < registers.size(); ++i) {
      const uint16_t r = registers[i];
      if (ready_[r] == 0) continue;
      const bool crosses = from_[r] != Pipe::Count && from_[r] != row.pipe && i < size_t(row.num_uses - row.num_defs);
      const Cycle later = i == guard_at ? guard : crosses ? crossing : 0;
      const Cycle at = ready_[r] == kNever ? kNever : ready_[r] + later;
      if (at > start.at) start = {at, wait_[r]};
    }
    return start;
  }
  // `from`: the pipe whose result it is; Count: none whose results reach others later.
  void set(std::span<const uint16_t> registers, Ready value, Pipe from = Pipe::Count) {
    for (uint16_t r : registers) {
      ready_[r] = value.at;
      wait_[r] = value.wait;
      from_[r] = from;
    }
  }

 private:
  std::array<Cycle, kScoreboardEntries> ready_{};
  std::array<Stall, kScoreboardEntries> wait_{};
  std::array<Pipe, kScoreboardEntries> from_{};
};

}  // namespace glint::core
