// Tests with random traffic that the counts are those of a simple reference, and that windows, skipping and
// repetition change nothing.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "tests/support/catch.h"
#include "tests/support/memory_rig.h"

using namespace glint;
using namespace glint::mem;

namespace {

constexpr uint32_t kCores = 3;
constexpr uint32_t kRequests = 1500;  // number of requests per core

// Returns parameters so small that every limit is met.
Params cramped(uint32_t variant) {
  Params p;
  p.l1.size = 32 * 128, p.l1.ways = variant % 2 ? 4 : 0;
  p.l1.mshr_entries = 6, p.l1.mshr_merges = 2, p.l1.miss_queue = 4;
  p.l1.ports = 1 + variant % 3, p.l1.banks = 4;
  p.noc.request_latency = 3 + variant % 5, p.noc.reply_latency = 4 + variant % 3;
  p.l1.allocate = variant % 2 ? "on_miss" : "on_fill";
  p.l1.write_allocate = variant % 3 == 1, p.l1.global_write_back = variant % 5 == 2;
  p.l1.fill_takes_access = variant % 4 < 2;
  p.noc.credits = variant % 4, p.noc.sides = variant % 6 == 5 ? 2 : 1,
  p.noc.far_latency = variant % 6 == 5 ? 9 : 0;
  p.noc.core_reply_bytes = 16, p.noc.partition_request_bytes = 12;
  p.l2.slice_size = 16 * 128, p.l2.ways = variant % 2 ? 16 : 4;
  p.l2.mshr_entries = 4, p.l2.mshr_merges = 2, p.l2.dram_queue = 8;
  p.l2.slices = variant % 6 == 5 ? 2 : variant % 7 == 4 ? 3 : 1;
  p.l2.write_masks = variant % 4 < 3, p.l2.fill_takes_service = variant % 5 < 3;
  p.hash = variant % 8 == 6 ? "none" : "mixed";
  p.dram.channels = 1 + variant % 3;
  p.dram.queue = 3 + variant % 4;
  p.dram.bus_bytes = variant % 4 == 3 ? 4 : variant % 4 == 2 ? 1 : 2;
  p.dram.dual_command_bus = variant % 2;
  p.dram.latency = variant % 2 ? 0 : 10;
  p.dram.scheduler = PolicyChoice<DramScheduler>(variant % 3 == 2   ? "fcfs"
                                                 : variant % 4 == 3 ? "write_drain"
                                                                    : "frfcfs");
  p.dram.refresh = variant % 3 == 0 ? "none" : variant % 3 == 1 ? "all_bank" : "per_bank";
  p.dram.activate_clocks = 1 + variant % 2;
  if (variant % 5 == 3) p.noc.topology = PolicyChoice<Network>("mesh");
  if (variant == 11) p.dram.model = PolicyChoice<DramModel>("simple");
  return p;
}

struct CoreTraffic {
  std::mt19937 random;
  std::optional<Request> pending;
  Token next = 0;
  uint64_t reads = 0, prefetches = 0, writes = 0, written_sectors = 0;  // prefetches are among the reads
  std::set<Address> lines_read;

  explicit CoreTraffic(uint32_t seed) : random(seed) {}
  // Accesses every line of a small range and now and then a line of a large one.
  Cycle step(L1Cache& l1, Cycle now) {
    if (next == kRequests) return kNever;
    for (uint32_t tries = 0; tries < 2 && next < kRequests; ++tries) {
      if (!pending) {
        const Address line = (random() % 4 ? random() % 48 : random() % 4096) * 128;
        const bool write = random() % 4 == 0;
        pending = Request{line, uint8_t(1 + random() % 15), write,
                          Traffic(random() % uint32_t(Traffic::Count)), next};
        if (write && random() % 2) pending->words = WordMask(random() | (random() % 2 ? 0xffffu : 0u));
      }
      if (!l1.access(now, Client(next % 2), *pending)) continue;
      if (pending->write)
        ++writes;
      else
        ++reads, lines_read.insert(pending->line), prefetches += pending->traffic == Traffic::RtPrefetch;
      pending.reset();
      ++next;
    }
    return now + 1 + (random() % 6 == 0 ? random() % 200 : 0);
  }
};

struct Collect final : stats::Visitor {
  std::vector<double> values;
  void enter(const stats::Group&) override {}
  void leave(const stats::Group&) override {}
  void visit(const stats::Counter& s) override { values.push_back(double(s.value())); }
  void visit(const stats::Ratio& s) override { values.push_back(s.value()); }
  void visit(const stats::Value& s) override { values.push_back(s.value()); }
  void visit(const stats::Histogram& s) override {
    for (const uint64_t n : s.counts()) values.push_back(double(n));
  }
  void visit(const stats::BreakdownBase& s) override {
    for (const auto& [name, n] : s.parts()) values.push_back(double(n));
  }
};

struct Outcome {
  std::vector<Answered> answers;
  std::vector<double> statistics;
  bool operator==(const Outcome&) const = default;
};

constexpr Cycle kEnd = 2'000'000;  // the counts end here, whatever the window is

Outcome simulate(uint32_t variant, Cycle window, bool step, uint32_t seed = 5) {
  MemoryRig rig(cramped(variant), kCores, 1365.0);
  if (window) rig.set_window(window);
  rig.set_step_every_cycle(step);
  std::vector<CoreTraffic> traffic;
  for (uint32_t c = 0; c < kCores; ++c) traffic.emplace_back(seed * 100 + c);
  rig.run([&](uint32_t core, Cycle now) { return traffic[core].step(rig.l1(core), now); });
  REQUIRE(rig.now() < kEnd);
  rig.memory().finish(kEnd);
  rig.memory().check_drained();

  uint64_t reads = 0, prefetches = 0;
  for (uint32_t c = 0; c < kCores; ++c) {
    const L1Stats& s = rig.l1(c).stats();
    reads += traffic[c].reads;
    prefetches += traffic[c].prefetches;
    CHECK(s.reads.total() == traffic[c].reads);
    CHECK(s.writes.total() == traffic[c].writes);
    CHECK(s.hits.total() + s.pending_hits.total() + s.misses.total() == traffic[c].reads);
    CHECK(s.cold_misses.total() <= traffic[c].lines_read.size());
    CHECK(s.sectors_fetched.total() == rig.l1(c).sectors_requested());
  }
  CHECK(rig.answers().size() == reads - prefetches);
  CHECK(prefetches > 0);
  for (uint32_t p = 0; p < rig.memory().num_partitions(); ++p) {
    const Partition& partition = rig.memory().partition(p);
    const DramStats& d = partition.dram().stats();
    for (uint32_t i = 0; i < partition.num_slices(); ++i)
      CHECK(partition.slice(i).stats().cycles.total() == kEnd);
    CHECK(d.use.total() == partition.dram().clocks().clock_at(kEnd));
    CHECK(d.requests.value() == d.reads.value() + d.writes.value());
    CHECK(d.picks.value() == d.requests.value());
    CHECK(d.busy_clocks.value() == d.requests.value() * partition.dram().data_clocks());
    if (variant != 11)
      CHECK(d.activates.value() + d.row_hits.value() == d.picks.value() + d.reopened.value());
  }
  Outcome out{rig.answers(), {}};
  Collect collect;
  rig.root().accept(collect);
  out.statistics = std::move(collect.values);
  return out;
}

}  // namespace

TEST_CASE("random traffic is conserved and the same run twice gives the same bytes") {
  const uint32_t variant = GENERATE(range(0u, 12u));
  const Outcome once = simulate(variant, 0, false);
  CHECK(once == simulate(variant, 0, false));
  CHECK(once != simulate(variant, 0, false, 6));
}

TEST_CASE("the window changes neither an answer nor a statistic") {
  const uint32_t variant = GENERATE(range(0u, 12u));
  const Outcome longest = simulate(variant, 0, false);
  for (const Cycle window : {Cycle{1}, Cycle{3}}) {
    const Outcome shorter = simulate(variant, window, false);
    CHECK(shorter.answers == longest.answers);
    CHECK(shorter.statistics == longest.statistics);
  }
}

TEST_CASE("stepping every cycle gives what skipping gives") {
  const uint32_t variant = GENERATE(range(0u, 12u));
  CHECK(simulate(variant, 1, true) == simulate(variant, 0, false));
}

TEST_CASE("without reuse every read fetches its sectors once, through L2 and DRAM alike") {
  Params params;
  MemoryRig rig(params, 1);
  constexpr uint32_t kLines = 3000;  // is more than L1 and L2 hold
  uint64_t sectors = 0;
  std::mt19937 random(1);
  Token next = 0;
  std::optional<Request> pending;
  rig.run([&](uint32_t, Cycle now) {
    if (!pending)
      pending = Request{Address{next} * 128, uint8_t(1 + random() % 15), false, Traffic::RtNode, next};
    if (rig.l1().access(now, Client::RtUnit, *pending))
      sectors += num_sectors(pending->sectors), pending.reset(), ++next;
    return next == kLines ? kNever : now + 1;
  });
  uint64_t dram_reads = 0;
  for (uint32_t p = 0; p < rig.memory().num_partitions(); ++p)
    dram_reads += rig.memory().partition(p).dram().stats().reads.value();
  CHECK(dram_reads == sectors);
  CHECK(rig.l1().stats().misses.count(Traffic::RtNode) == kLines);
  CHECK(rig.l1().stats().cold_misses.count(Traffic::RtNode) == kLines);
}
