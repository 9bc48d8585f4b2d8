// Declares the statistics of a DRAM channel: commands, queueing, and what each of its clocks went into.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <iterator>
#include <string_view>

#include "base/stats.h"

namespace glint::mem {

// Says what a command clock went into. Each clock has exactly one reason, which is the first that applies.
// GPGPU-Sim's split of the bandwidth counts `turnaround` as `column_wait` and has no refresh.
enum class DramUse : uint8_t {
  Data,        // the data bus was in use
  Turnaround,  // every bank with its row open waits for the bus to turn between reading and writing
  ColumnWait,  // a bank has its row open, and its column command waits for its activate or for other columns
  Refresh,     // every bank with a request is in refresh, or waits for it
  RowWait,     // banks have requests, and none of them has its row open
  Idle,
  Count
};
constexpr std::string_view name_of(DramUse use) {
  constexpr std::string_view kNames[] = {"data", "turnaround", "column_wait", "refresh", "row_wait", "idle"};
  static_assert(std::size(kNames) == size_t(DramUse::Count));
  return kNames[size_t(use)];
}

struct DramStats {
  // `bytes_per_clock` is the width of the data bus.
  DramStats(stats::Group* parent, double bytes_per_clock)
      : group(parent, "dram"),
        activates_per_kb(
            &group, "activates_per_kb", "command/KB",
            [this, bytes_per_clock] {
              return busy_clocks.value()
                         ? double(activates.value()) * 1000 / (double(busy_clocks.value()) * bytes_per_clock)
                         : 0.0;
            },
            "Number of rows opened for each 1000 bytes of data.") {}
  stats::Group group;
  stats::Counter reads{&group, "reads", "request",
                       "Number of read requests whose column command was issued."};
  stats::Counter writes{&group, "writes", "request",
                        "Number of write requests whose column command was issued."};
  stats::Counter activates{&group, "activates", "command", "Number of rows opened."};
  stats::Counter precharges{&group, "precharges", "command", "Number of rows closed to open another."};
  stats::Counter refreshes{&group, "refreshes", "command",
                           "Number of refresh commands, for all banks or for one."};
  stats::Counter reopened{&group, "reopened", "command",
                          "Number of rows that a refresh closed under a request and that were opened again."};
  stats::Counter row_hits{&group, "row_hits", "request",
                          "Number of requests whose row was open when their bank took them."};
  stats::Counter turnarounds{&group, "turnarounds", "command",
                             "Number of changes of the data bus between reading and writing."};
  stats::Counter picks{&group, "picks", "request",
                       "Number of requests that a bank has taken from the scheduler."};
  stats::Counter clocks{&group, "clocks", "clock", "Number of command clocks simulated."};
  stats::Counter busy_clocks{&group, "busy_clocks", "clock", "Number of command clocks in which data moved."};
  stats::Counter active_clocks{&group, "active_clocks", "clock",
                               "Number of command clocks in which a bank held a request or a timer ran."};
  stats::Counter bank_clocks{&group, "bank_clocks", "clock",
                             "Number of command clocks in which a bank held a request, summed over banks."};
  stats::Counter any_bank_clocks{&group, "any_bank_clocks", "clock",
                                 "Number of command clocks in which at least one bank held a request."};
  stats::Counter queue_clocks{&group, "queue_clocks", "clock",
                              "Clocks from the queue to the column command, summed over requests."};
  stats::Breakdown<DramUse> use{&group, "use", "clock", "Number of command clocks, by what they went into."};
  stats::Histogram queue_latency{&group, "queue_latency", "clock", stats::linear(0, 1024, 16),
                                 "Clocks from the queue to the column command of a request."};
  stats::Counter requests{&group, "requests", "request", "Number of requests taken into the queue."};
  // These four have GPGPU-Sim's definitions (dram.cc, dram_sched.cc), so that numbers can be compared with
  // its bw_util, dram_eff, row buffer locality as the scheduler picks, and bank-level parallelism.
  stats::Ratio utilisation{&group,      "utilisation", "ratio",
                           busy_clocks, clocks,        "Share of all clocks that carried data."};
  stats::Ratio efficiency{&group,      "efficiency",  "ratio",
                          busy_clocks, active_clocks, "Share of the active clocks that carried data."};
  stats::Ratio row_buffer_locality{
      &group, "row_buffer_locality", "ratio", row_hits, picks, "Share of picks that hit the open row."};
  stats::Ratio bank_parallelism{&group,          "bank_parallelism",
                                "bank",          bank_clocks,
                                any_bank_clocks, "Mean number of banks that held a request while any did."};
  stats::Ratio mean_queue_latency{&group,  "mean_queue_latency",
                                  "clock", queue_clocks,
                                  picks,   "Mean clocks from the queue to the column command of a request."};
  stats::Value p99_queue_latency{&group, "p99_queue_latency", "clock", [this] { return p99(); },
                                 "Clocks from the queue to the column command that 99 % of requests did not "
                                 "exceed, which is the upper end of a bin."};
  stats::Value activates_per_kb;

 private:
  double p99() const {
    uint64_t total = 0, sum = 0;
    for (const uint64_t n : queue_latency.counts()) total += n;
    for (size_t bin = 0; bin < queue_latency.counts().size(); ++bin) {
      sum += queue_latency.counts()[bin];
      if (total > 0 && sum * 100 >= total * 99) return double((bin + 1) * queue_latency.bins().step);
    }
    return 0.0;
  }
};

}  // namespace glint::mem
