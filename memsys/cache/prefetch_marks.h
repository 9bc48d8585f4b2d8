// Remembers which sectors of a cache a prefetch has brought and nobody has read yet.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "base/stats.h"
#include "memsys/request.h"

namespace glint::mem {

// Every sector that a prefetch asked for is useful, late or unused: sectors = useful + late + unused.
struct PrefetchStats {
  explicit PrefetchStats(stats::Group* parent) : group(parent, "prefetch") {}
  stats::Group group;
  stats::Counter sectors{&group, "sectors", "sector", "Number of sectors that prefetches asked of the L2."};
  stats::Counter useful{&group, "useful", "sector",
                        "Number of prefetched sectors that were present when they were read first."};
  stats::Counter late{&group, "late", "sector",
                      "Number of prefetched sectors that were still on the way when they were read first."};
  stats::Value unused{&group, "unused", "sector",
                      [this] { return double(sectors.value() - useful.value() - late.value()); },
                      "Number of prefetched sectors that nobody read before they left the cache."};
  stats::Value accuracy{
      &group, "accuracy", "sector/sector",
      [this] {
        return sectors.value() ? double(useful.value() + late.value()) / double(sectors.value()) : 0.0;
      },
      "Share of the prefetched sectors that were read, in time or late."};
};

// A sector is marked from the prefetch that asks for it until it is read or leaves the cache. Without
// prefetches, each call costs one test of a flag.
class PrefetchMarks {
 public:
  // `lines` and `entries` are the numbers of the cache's lines and MSHRs.
  PrefetchMarks(uint32_t lines, uint32_t entries, PrefetchStats& stats)
      : in_line_(lines), in_entry_(entries), stats_(stats) {}

  // A prefetch has asked for sectors of the line of an MSHR.
  void sent(uint32_t entry, uint8_t sectors) {
    is_active_ = true;
    in_entry_[entry] |= sectors;
    stats_.sectors += num_sectors(sectors);
  }
  // A read waits for sectors that are on the way.
  void awaited(uint32_t entry, uint8_t sectors) {
    if (is_active_) take(in_entry_[entry], sectors, stats_.late);
  }
  // Sectors on the way have come into the line in `slot`.
  void arrived(uint32_t entry, uint32_t slot, uint8_t sectors) {
    if (!is_active_) return;
    in_line_[slot] |= uint8_t(in_entry_[entry] & sectors);
    in_entry_[entry] &= uint8_t(~sectors);
  }
  // Sectors on the way have come, and the cache did not keep them.
  void lost(uint32_t entry, uint8_t sectors) { in_entry_[entry] &= uint8_t(~sectors); }
  // A read has found sectors of the line in `slot`.
  void used(uint32_t slot, uint8_t sectors) {
    if (is_active_) take(in_line_[slot], sectors, stats_.useful);
  }
  // Sectors of the line in `slot` leave the cache.
  void forget(uint32_t slot, uint8_t sectors) {
    if (is_active_) in_line_[slot] &= uint8_t(~sectors);
  }

 private:
  static void take(uint8_t& marks, uint8_t sectors, stats::Counter& count) {
    if (!(marks & sectors)) return;
    count += num_sectors(marks & sectors);
    marks &= uint8_t(~sectors);
  }

  bool is_active_ = false;                   // There has been a prefetch.
  std::vector<uint8_t> in_line_, in_entry_;  // marked sectors, by slot and by MSHR
  PrefetchStats& stats_;
};

}  // namespace glint::mem
