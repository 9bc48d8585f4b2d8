// Knows when each register and predicate of one warp can be read or overwritten.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

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

  // Makes room for who reads which register. It is called once, where hold() will be.
  void keep_reads() { reads_.resize(kScoreboardEntries); }
  void reset() {
    entries_.fill(0);
    std::fill(reads_.begin(), reads_.end(), Reads{});
  }
  // Returns when all of `registers` are ready. It is not before `start`, which waits for `start.wait`.
  Ready ready(std::span<const uint16_t> registers, Ready start) const {
    Entry last = entry(start);
    for (uint16_t r : registers) last = later(last, entries_[r]);
    return {ready_at(last), wait_of(last)};
  }
  // Does the same for `uses`, the registers of `row`.
  Ready ready(const IssueRow& row, std::span<const uint16_t> uses, Ready start) const {
    Entry last = entry(start);
    for (uint16_t r : row.first_uses) last = later(last, entries_[r]);
    if (uses.size() > row.first_uses.size()) [[unlikely]]
      for (uint16_t r : uses.subspan(row.first_uses.size())) last = later(last, entries_[r]);
    return {ready_at(last), wait_of(last)};
  }
  // Does the same when results reach other pipes `crossing` cycles later than their own and guards `guard`
  // cycles later, and when the instruction's own results may come `slack` cycles after those that it waits
  // for.
  Ready ready(std::span<const uint16_t> registers, Ready start, const IssueRow& row, Cycle crossing,
              Cycle guard, Cycle slack) const {
    const size_t guard_at = row.is_guarded ? size_t(row.num_uses - row.num_defs - 1) : registers.size();
    for (size_t i = 0; i < registers.size(); ++i) {
      const Entry entry = entries_[registers[i]];
      const Cycle result = ready_at(entry);
      if (result == 0) continue;
      const bool is_source = i < size_t(row.num_uses - row.num_defs);
      const bool crosses = from_of(entry) != Pipe::Count && from_of(entry) != row.pipe && is_source;
      const Cycle delay = i == guard_at ? guard : crosses ? crossing : 0;
      const Cycle at = result == kNever ? kNever : before(result + delay, is_source ? 0 : slack);
      start = later(start, {at, wait_of(entry)});
    }
    return start;
  }
  // Does the same for an instruction whose results come `latency` cycles after its issue. Earlier results of
  // its registers only have to come before these.
  Ready ready_in_order(std::span<const uint16_t> sources, std::span<const uint16_t> results, Ready start,
                       Cycle latency) const {
    start = ready(sources, start);
    for (uint16_t r : results)
      start = later(start, {before(ready_at(entries_[r]), latency - 1), wait_of(entries_[r])});
    return start;
  }
  // Returns when all of `registers` have been read by the instructions that hold them.
  Ready unread(std::span<const uint16_t> registers, Ready start) const {
    for (uint16_t r : registers) {
      const Cycle at = reads_[r].readers ? kNever : reads_[r].until;
      start = later(start, {at, Stall::OperandRead});
    }
    return start;
  }
  void hold(std::span<const uint16_t> registers) {
    for (uint16_t r : registers) ++reads_[r].readers;
  }
  // Notes that an instruction which holds the registers reads them until `end`.
  void read(std::span<const uint16_t> registers, Cycle end) {
    for (uint16_t r : registers) {
      --reads_[r].readers;
      reads_[r].until = std::max(reads_[r].until, end);
    }
  }
  // Forgets what waits for accesses to memory that have not been answered.
  void forget_accesses() {
    for (Entry& entry : entries_)
      if (ready_at(entry) == kNever && waits_for_memory(wait_of(entry))) entry = 0;
  }
  // Sets the ready time. `from` is the pipe whose result it is. Count stands for a result that reaches all
  // pipes at the same time.
  void set(std::span<const uint16_t> registers, Ready value, Pipe from = Pipe::Count) {
    for (uint16_t r : registers) entries_[r] = entry(value, from);
  }
  // Does the same for `defs`, the destinations of `row`.
  void set(const IssueRow& row, std::span<const uint16_t> defs, Ready value, Pipe from) {
    entries_[row.first_def] = entry(value, from);
    if (defs.size() > 1) [[unlikely]]
      set(defs.subspan(1), value, from);
  }
  // Does the same for an instruction that writes one register at most (IssueRow::is_value).
  void set_value(const IssueRow& row, Ready value) { entries_[row.first_def] = entry(value); }

 private:
  // Holds when a register is ready, what it waits for until then, and the pipe whose result it is, from the
  // highest bits to the lowest. One comparison of two words then finds the later of two registers.
  using Entry = uint64_t;
  static constexpr int kReadyShift = 16, kWaitShift = 8;
  static constexpr Cycle kNeverHere = kNever >> kReadyShift;  // stands for kNever

  static Entry entry(const Ready& value, Pipe from = Pipe::Count) {
    return value.at << kReadyShift | Entry(value.wait) << kWaitShift | Entry(from);
  }
  static Cycle ready_at(Entry entry) {
    const Cycle at = entry >> kReadyShift;
    return at == kNeverHere ? kNever : at;
  }
  static Stall wait_of(Entry entry) { return Stall(entry >> kWaitShift & 0xff); }
  static Pipe from_of(Entry entry) { return Pipe(entry & 0xff); }

  // These return the later of two, the first if they are equal. There is no branch, because which of an
  // instruction's registers comes last cannot be foreseen.
  static Entry later(Entry first, Entry second) {
    constexpr Entry kBelowReady = (Entry{1} << kReadyShift) - 1;
    return second > (first | kBelowReady) ? second : first;
  }
  static Ready later(const Ready& first, const Ready& second) {
    const bool takes_second = second.at > first.at;
    return {takes_second ? second.at : first.at, takes_second ? second.wait : first.wait};
  }
  static Cycle before(Cycle at, Cycle cycles) {
    return at == kNever ? kNever : std::max(at, cycles) - cycles;
  }

  // Says who reads a register that another instruction is about to overwrite.
  struct Reads {
    Cycle until = 0;       // It is read until then.
    uint32_t readers = 0;  // memory instructions that have not read the register yet
  };

  std::array<Entry, kScoreboardEntries> entries_{};
  // It is empty where memory instructions do not hold registers, which saves 133 bytes of the host a thread.
  std::vector<Reads> reads_;
};

}  // namespace glint::core
