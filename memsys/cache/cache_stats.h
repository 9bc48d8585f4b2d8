// Declares the statistics that L1 and L2 have in common. Most of them are counted by traffic class.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>

#include "base/stats.h"
#include "memsys/cache/line_set.h"
#include "memsys/request.h"

namespace glint::mem {

// Says why a cache refused a request.
enum class Refusal : uint8_t { Port, Bank, MshrFull, MergeLimit, QueueFull, SetHeld, Count };
constexpr std::string_view name_of(Refusal reason) {
  constexpr std::string_view kNames[] = {"port",        "bank",       "mshr_full",
                                         "merge_limit", "queue_full", "set_held"};
  static_assert(std::size(kNames) == size_t(Refusal::Count));
  return kNames[size_t(reason)];
}

// Every read is a hit, a pending hit or a miss: reads = hits + pending_hits + misses.
struct CacheStats {
  CacheStats(stats::Group* parent, const std::string& name) : group(parent, name) {}
  stats::Group group;
  stats::Breakdown<Traffic> reads{&group, "reads", "request",
                                  "Number of reads that the cache took, by traffic class."};
  stats::Breakdown<Traffic> hits{&group, "hits", "request",
                                 "Number of reads that found all their sectors present."};
  stats::Breakdown<Traffic> pending_hits{
      &group, "pending_hits", "request",
      "Number of reads whose missing sectors were all on the way already."};
  stats::Breakdown<Traffic> misses{&group, "misses", "request",
                                   "Number of reads that fetched at least one sector."};
  stats::Breakdown<Traffic> cold_misses{
      &group, "cold_misses", "request",
      "Number of misses of lines that this cache had never held or fetched."};
  stats::Breakdown<Traffic> writes{&group, "writes", "request", "Number of writes that the cache took."};
  stats::Breakdown<Traffic> write_hits{&group, "write_hits", "request",
                                       "Number of writes whose line was present."};
  stats::Breakdown<Traffic> sectors_fetched{&group, "sectors_fetched", "sector",
                                            "Number of sectors that misses asked of the level below."};
  stats::Counter write_backs{&group, "write_backs", "line", "Number of dirty lines that were evicted."};
  stats::Counter evictions{&group, "evictions", "line",
                           "Number of lines that were replaced, clean or dirty."};

  // Counts a read that the cache took. `seen` holds all lines that the cache has held or fetched.
  void count_read(Traffic traffic, uint8_t missing, uint8_t fetched, Address line, LineSet& seen) {
    reads.add(traffic);
    if (missing == 0) return hits.add(traffic);
    if (fetched == 0) return pending_hits.add(traffic);
    misses.add(traffic);
    sectors_fetched.add(traffic, num_sectors(fetched));
    if (seen.insert_if_new(line)) cold_misses.add(traffic);
  }
};

}  // namespace glint::mem
