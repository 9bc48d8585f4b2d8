// Models miss status holding registers (MSHRs). They know which lines are being fetched, and who waits for
// which of their sectors.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "base/check.h"
#include "base/types.h"
#include "memsys/cache/line_table.h"
#include "memsys/host_block.h"

namespace glint::mem {

// There is a fixed number of entries, each of which holds up to a fixed number of waiters. `Waiter` is a
// plain struct. Model: an entry covers a line and knows which of its sectors are on the way, where GPGPU-Sim
// gives each 32-byte sector an entry of its own.
template <class Waiter>
class Mshr {
 public:
  static constexpr uint32_t kNone = LineTable::kNone;

  Mshr(uint32_t entries, uint32_t merges)
      : entries_(entries),
        waiters_(size_t(entries) * merges, Filling::Sparse),
        index_(entries),
        merges_(merges) {
    for (uint32_t i = 0; i < entries_.size(); ++i)
      entries_[i].first = i + 1 < entries_.size() ? i + 1 : kNone;
  }

  uint32_t find(Address line) const { return index_.find(line); }
  bool full() const { return free_entry_ == kNone; }
  bool merge_limit(uint32_t entry) const { return entries_[entry].count == merges_; }
  uint8_t pending(uint32_t entry) const { return entries_[entry].pending; }
  size_t in_use() const { return index_.size(); }

  uint32_t allocate(Address line) {
    const uint32_t id = free_entry_;
    GLINT_DCHECK(id != kNone, "no free MSHR");
    free_entry_ = entries_[id].first;
    entries_[id] = {line, 0, 0, kNone, kNone};
    index_.insert(line, id);
    return id;
  }
  void expect(uint32_t entry, uint8_t sectors) { entries_[entry].pending |= sectors; }
  void add(uint32_t entry, const Waiter& waiter) {
    uint32_t id = free_waiter_;
    if (id == kNone)
      id = num_used_++;
    else
      free_waiter_ = waiters_[id].next;
    GLINT_DCHECK(id < waiters_.size(), "no free waiter");
    waiters_[id] = {waiter, kNone};
    Entry& e = entries_[entry];
    (e.last == kNone ? e.first : waiters_[e.last].next) = id;
    e.last = id;
    ++e.count;
  }
  // Returns who has waited for longest, or null when nobody waits.
  const Waiter* first_waiter(uint32_t entry) const {
    return entries_[entry].count ? &waiters_[entries_[entry].first].waiter : nullptr;
  }
  // Notes that `sectors` arrived and visits the waiters, oldest first. `visit` returns true for a waiter that
  // is served. The entry is free again when no sector is on the way; every waiter must be served by then.
  template <class Visit>
  void arrive(uint32_t entry, uint8_t sectors, Visit&& visit) {
    Entry& e = entries_[entry];
    e.pending &= uint8_t(~sectors);
    uint32_t before = kNone;
    for (uint32_t id = e.first; id != kNone;) {
      const uint32_t next = waiters_[id].next;
      if (visit(waiters_[id].waiter)) {
        (before == kNone ? e.first : waiters_[before].next) = next;
        if (e.last == id) e.last = before;
        waiters_[id].next = free_waiter_;
        free_waiter_ = id;
        --e.count;
      } else {
        before = id;
      }
      id = next;
    }
    if (e.pending) return;
    GLINT_DCHECK(e.count == 0, "an MSHR is freed with waiters");
    index_.erase(e.line);
    e.first = free_entry_;
    free_entry_ = entry;
  }

 private:
  struct Entry {
    Address line = 0;
    uint8_t pending = 0;                   // sectors on the way
    uint32_t count = 0;                    // number of waiters
    uint32_t first = kNone, last = kNone;  // first and last waiter; `first` also links free entries
  };
  struct Link {
    Waiter waiter{};
    uint32_t next = kNone;
  };

  std::vector<Entry> entries_;
  HostArray<Link> waiters_;  // large, and mostly never touched
  LineTable index_;
  uint32_t merges_;
  uint32_t free_entry_ = 0, free_waiter_ = kNone;
  uint32_t num_used_ = 0;  // waiters that have ever been in use, which have the first numbers
};

}  // namespace glint::mem
