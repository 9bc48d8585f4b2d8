// Tests where the time of a miss goes: each stage to the cycle, and their sum.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <fmt/format.h>

#include "tests/support/catch.h"
#include "tests/timing/memsys/requests.h"

using namespace glint;
using namespace glint::mem;

namespace {

using Split = std::array<uint64_t, size_t(Stage::Count)>;

Split split_of(const L1Cache& l1) {
  Split out{};
  for (size_t i = 0; i < out.size(); ++i) out[i] = l1.stats().miss_stages.count(Stage(i));
  return out;
}
Split difference(const Split& after, const Split& before) {
  Split out{};
  for (size_t i = 0; i < out.size(); ++i) out[i] = after[i] - before[i];
  return out;
}

// Returns the stages of one read of a line that the L2 has.
Split l2_hit(const Params& params) {
  MemoryRig rig(params);
  rig.read_latency(kLine, 1, true);
  rig.read_latency(kLine, 1);
  return split_of(rig.l1());
}

}  // namespace

TEST_CASE("an unloaded L2 hit spends its cycles in tags, on the way, in the slice and on the way back") {
  Params params;
  CHECK(l2_hit(params) == Split{20, 1 + 48, 0, 42, 0, 0, 0, 1 + 48});
}

TEST_CASE("each latency moves the stage that it belongs to, and no other") {
  const Params base;
  const Split unchanged = l2_hit(base);
  const auto moved = [&](auto change, Stage stage, uint64_t by) {
    Params params;
    change(params);
    Split expected = unchanged;
    expected[size_t(stage)] += by;
    return l2_hit(params) == expected;
  };
  CHECK(moved([](Params& p) { p.l1.miss_latency += 3; }, Stage::L1Queue, 3));
  CHECK(moved([](Params& p) { p.noc.request_latency += 5; }, Stage::Request, 5));
  CHECK(moved([](Params& p) { p.l2.latency += 11; }, Stage::L2Service, 11));
  CHECK(moved([](Params& p) { p.noc.reply_latency += 7; }, Stage::Reply, 7));
}

TEST_CASE("an unloaded read of DRAM adds its way, its clock edge and row, and its column and data") {
  Params params;
  params.dram.clock_mhz = 1000.0;
  params.dram.rcd = 15, params.dram.cl = 14;
  MemoryRig rig(params, 1, 1000.0);
  rig.read_latency(kLine, 1);
  CHECK(split_of(rig.l1()) == Split{20, 49, 0, 42, 100, 1 + 15, 14 + 4, 49});
  CHECK(rig.l1().stats().dram_latency.counts()[(20 + 49 + 42 + 100 + 16 + 18 + 49) / 32] == 1);
}

TEST_CASE("who comes when the data is nearly there has no part in the stages before") {
  Params params;
  MemoryRig rig(params);
  rig.read_latency(kLine, 1, true);
  const Cycle start = rig.now();
  Split first{};
  // The second read comes 100 cycles later: its last 60 of 160 are 11 in the slice and the 49 of the reply.
  rig.run([&](uint32_t, Cycle now) {
    rig.l1().access(now, Client::RtUnit, {kLine, 1, false, Traffic::RtNode, 1});
    return now == start ? start + 100 : kNever;
  });
  first = {20, 49, 0, 42, 0, 0, 0, 49};
  CHECK(difference(split_of(rig.l1()), first) == Split{0, 0, 0, 11, 0, 0, 0, 49});
  CHECK(rig.l1().stats().miss_cycles.value() == 160 + 60);
}

TEST_CASE("packets that meet at a slice wait in its queue, and the stages add up to the latencies") {
  Params params;
  params.l1.mshr_entries = 64;
  MemoryRig rig(params, 4);
  std::array<uint32_t, 4> sent{};
  rig.run([&](uint32_t core, Cycle now) {  // all reads are of one partition and of four sectors
    const Address line = Address{256} * params.dram.channels * (sent[core] + core * 1000);
    if (rig.l1(core).access(now, Client::RtUnit, {line, 0xf, false, Traffic::RtNode, sent[core]}))
      ++sent[core];
    return sent[core] == 100 ? kNever : now + 1;
  });
  Split all{};
  uint64_t cycles = 0, misses = 0;
  for (uint32_t core = 0; core < 4; ++core) {
    const Split split = split_of(rig.l1(core));
    for (size_t i = 0; i < all.size(); ++i) all[i] += split[i];
    cycles += rig.l1(core).stats().miss_cycles.value();
    misses += rig.l1(core).stats().timed_misses.value();
    CHECK(rig.l1(core).stats().miss_stages.total() == rig.l1(core).stats().miss_cycles.value());
  }
  CHECK(misses == 400);
  CHECK(all[size_t(Stage::L2Queue)] > 0);
  CHECK(all[size_t(Stage::DramQueue)] > all[size_t(Stage::DramService)]);
  // Nothing can delay these two: the slice's own latency and the way to DRAM.
  CHECK(all[size_t(Stage::L2Service)] == 400 * 42);
  CHECK(all[size_t(Stage::DramWay)] == 400 * 100);
  CHECK(cycles > 400 * 276);
}

TEST_CASE("an L1 that waits says for how many reads, and what stands first in its queue") {
  Params params;
  MemoryRig rig(params);
  CHECK(rig.l1().describe() == "");
  REQUIRE(rig.l1().access(0, Client::Lsu, {kLine, 3, false, Traffic::RtNode, 1}));
  CHECK(rig.l1().describe() ==
        fmt::format("  L1: 1 reads without an answer, 1 lines on the way, 0 of 2 sectors have come\n"
                    "  L1: 1 packets wait to leave, the first reads line {:#x} for partition {}\n",
                    kLine, rig.memory().map().partition(kLine)));
}
