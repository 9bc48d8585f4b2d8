// Tests the L1 and the round trip behind it, to the cycle.
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.h"
#include "tests/timing/memsys/requests.h"

using namespace glint;
using namespace glint::mem;

namespace {

// Returns what the formula of memsys/README.md gives. One sector fits a default port in one cycle.
Cycle l2_hit_round_trip(const Params& p) {
  return p.l1.miss_latency + 1 + p.noc.request_latency + p.l2.latency + 1 + p.noc.reply_latency;
}

}  // namespace

TEST_CASE("an L1 hit returns its token at exactly the hit latency, not a cycle before") {
  Params params;
  params.l1.hit_latency = GENERATE(1u, 20u, 33u);
  MemoryRig rig(params);
  rig.read_latency(kLine, 1);
  const Cycle now = rig.now();
  REQUIRE(rig.l1().access(now, Client::RtUnit, read(kLine, 7)));
  CHECK(rig.l1().next_event(now) == now + params.l1.hit_latency);
  CHECK_FALSE(rig.l1().pop(now + params.l1.hit_latency - 1, Client::RtUnit));
  CHECK_FALSE(rig.l1().pop(now + params.l1.hit_latency, Client::Lsu));
  CHECK(rig.l1().pop(now + params.l1.hit_latency, Client::RtUnit) == Token{7});
}

TEST_CASE("an unloaded L2 hit takes the sum of its parts, 160 cycles by default") {
  Params params;
  MemoryRig rig(params);
  REQUIRE(rig.read_latency(kLine, 1, true) == 0);  // a write brings the sector into L2 and not into L1
  CHECK(l2_hit_round_trip(params) == 160);
  CHECK(rig.read_latency(kLine, 1) == l2_hit_round_trip(params));
}

TEST_CASE(
    "a wider reply takes a port cycle more for each 40 bytes and a slice cycle more for each two sectors") {
  Params params;
  MemoryRig rig(params);
  rig.read_latency(kLine, 0b1111, true);
  // The last of the 4 sectors is read a cycle after the first two, and 136 bytes take 4 cycles of the port
  // instead of 1.
  CHECK(rig.read_latency(kLine, 0b1111) == l2_hit_round_trip(params) + 1 + 3);
}

TEST_CASE("each latency parameter moves the L2 hit by itself") {
  const auto latency = [](auto change) {
    Params params;
    change(params);
    MemoryRig rig(params);
    rig.read_latency(kLine, 1, true);
    return rig.read_latency(kLine, 1);
  };
  const Cycle base = latency([](Params&) {});
  CHECK(latency([](Params& p) { p.l1.miss_latency += 3; }) == base + 3);
  CHECK(latency([](Params& p) { p.noc.request_latency += 5; }) == base + 5);
  CHECK(latency([](Params& p) { p.noc.reply_latency += 7; }) == base + 7);
  CHECK(latency([](Params& p) { p.l2.latency += 11; }) == base + 11);
  CHECK(latency([](Params& p) { p.noc.partition_reply_bytes = 20; }) == base + 1);
  CHECK(latency([](Params& p) { p.noc.core_reply_bytes = 20; }) == base + 1);
  CHECK(latency([](Params& p) { p.noc.core_request_bytes = 4; }) == base + 1);
  CHECK(latency([](Params& p) { p.l1.hit_latency += 9; }) == base);
}

TEST_CASE("an unloaded DRAM access takes the L2 path, the way to DRAM, and activate, read and data clocks") {
  Params params;
  MemoryRig rig(params, 1, 1000.0);
  params.dram.clock_mhz = 1000.0;
  params.dram.rcd = 15, params.dram.cl = 14;
  MemoryRig same_clock(params, 1, 1000.0);
  // The request is seen at the clock edge after it arrives, and data of 16 transfers take 4 clocks.
  CHECK(same_clock.read_latency(kLine, 1) ==
        l2_hit_round_trip(params) + params.dram.latency + 1 + 15 + 14 + 4);
}

TEST_CASE("misses of different lines leave the request port one a cycle") {
  Params params;
  params.l1.ports = 4, params.l1.banks = 64;
  MemoryRig rig(params);
  for (Address i = 0; i < 4; ++i) rig.read_latency(kLine + i * 128, 1, true);  // the L2 then has all
  const Cycle start = rig.now();
  rig.run([&](uint32_t, Cycle now) {
    if (now == start)
      for (Token i = 0; i < 4; ++i) REQUIRE(rig.l1().access(now, Client::Lsu, read(kLine + i * 128, i)));
    return kNever;
  });
  // Different partitions serve them, so only the port spaces them; there is one fill per cycle.
  for (Token i = 0; i < 4; ++i) CHECK(rig.answers()[i].at == start + l2_hit_round_trip(params) + i);
}

TEST_CASE("a narrow request port spaces write packets by their bytes") {
  Params params;
  params.noc.core_request_bytes = 8;
  MemoryRig rig(params);
  const Cycle start = rig.now();
  // The first write has 136 bytes, which take 17 cycles. The second is ready a cycle later and waits for 16.
  REQUIRE(rig.l1().access(start, Client::Lsu, write(kLine, 0b1111)));
  REQUIRE(rig.l1().access(start + 1, Client::Lsu, write(kLine + 128, 0b1)));
  rig.drain();
  CHECK(rig.l1().stats().request_bytes.value() == 136 + 40);
  CHECK(rig.l1().stats().request_wait.value() == 16);
}

TEST_CASE("a cycle takes as many accesses as there are ports and the next cycle takes more") {
  Params params;
  params.l1.ports = 2, params.l1.banks = 4;
  MemoryRig rig(params);
  CHECK(rig.l1().access(0, Client::Lsu, read(0, 0)));
  CHECK(rig.l1().access(0, Client::RtUnit, read(128, 1)));
  CHECK_FALSE(rig.l1().access(0, Client::Lsu, read(256, 2)));
  CHECK(rig.l1().stats().refusals.count(Refusal::Port) == 1);
  CHECK(rig.l1().access(1, Client::Lsu, read(256, 2)));
}

TEST_CASE("two lines of one bank are not taken in one cycle") {
  Params params;
  params.l1.ports = 4, params.l1.banks = 4;
  MemoryRig rig(params);
  CHECK(rig.l1().access(0, Client::Lsu, read(0, 0)));
  CHECK_FALSE(rig.l1().access(0, Client::Lsu, read(4 * 128, 1)));
  CHECK(rig.l1().stats().refusals.count(Refusal::Bank) == 1);
  CHECK(rig.l1().access(0, Client::Lsu, read(5 * 128, 2)));
}

TEST_CASE("a full MSHR refuses a new line, still merges, and takes a line again after a fill") {
  Params params;
  params.l1.mshr_entries = 2;
  MemoryRig rig(params);
  L1Cache& l1 = rig.l1();
  CHECK(l1.access(0, Client::Lsu, read(0, 0)));
  CHECK(l1.access(1, Client::Lsu, read(128, 1)));
  CHECK_FALSE(l1.access(2, Client::Lsu, read(256, 2)));
  CHECK(l1.stats().refusals.count(Refusal::MshrFull) == 1);
  CHECK(l1.access(2, Client::Lsu, read(0, 3)));
  rig.drain();
  CHECK(rig.answers().size() == 3);
  CHECK(l1.access(rig.now(), Client::Lsu, read(256, 2)));
}

TEST_CASE("an MSHR merges up to its limit, the first read included") {
  Params params;
  params.l1.mshr_merges = 3;
  MemoryRig rig(params);
  for (Cycle i = 0; i < 3; ++i) CHECK(rig.l1().access(i, Client::Lsu, read(0, Token(i))));
  CHECK_FALSE(rig.l1().access(3, Client::Lsu, read(0, 3)));
  CHECK(rig.l1().stats().refusals.count(Refusal::MergeLimit) == 1);
  rig.drain();
  REQUIRE(rig.answers().size() == 3);
  for (Token i = 0; i < 3; ++i) {
    CHECK(rig.answers()[i].at == rig.answers()[0].at);
    CHECK(rig.answers()[i].token == i);
  }
  CHECK(rig.l1().packets_sent() == 1);
}

TEST_CASE("a full miss queue refuses misses and writes but not hits or merges") {
  Params params;
  MemoryRig rig(params);
  rig.read_latency(kLine, 1);
  Params narrow;
  narrow.l1.miss_queue = 2;
  MemoryRig small(narrow);
  L1Cache& l1 = small.l1();
  CHECK(l1.access(0, Client::Lsu, read(0, 0)));
  CHECK(l1.access(1, Client::Lsu, write(128)));
  CHECK_FALSE(l1.access(2, Client::Lsu, read(256, 1)));
  CHECK_FALSE(l1.access(2, Client::Lsu, write(256)));
  CHECK(l1.stats().refusals.count(Refusal::QueueFull) == 2);
  CHECK(l1.access(2, Client::Lsu, read(0, 2)));
  // The first packet leaves at its miss latency and makes room in that cycle.
  l1.tick(narrow.l1.miss_latency - 1);
  CHECK_FALSE(l1.access(narrow.l1.miss_latency - 1, Client::Lsu, read(256, 1)));
  l1.tick(narrow.l1.miss_latency);
  CHECK(l1.access(narrow.l1.miss_latency, Client::Lsu, read(256, 1)));
}

TEST_CASE("a write updates sectors that are present and allocates no line") {
  Params params;
  MemoryRig rig(params);
  rig.read_latency(kLine, 1, true);
  CHECK(rig.l1().stats().write_hits.total() == 0);
  CHECK(rig.read_latency(kLine, 1) == 160);  // the write left nothing in the L1
  rig.read_latency(kLine, 1, true);
  CHECK(rig.l1().stats().write_hits.total() == 1);
  CHECK(rig.read_latency(kLine, 1) == params.l1.hit_latency);
}

TEST_CASE("local writes stay in the L1 until their line is evicted") {
  Params params;
  params.l1.size = 2 * 128;
  MemoryRig rig(params);
  L1Cache& l1 = rig.l1();
  CHECK(l1.access(0, Client::Lsu, write(0, 0b0011, Traffic::ShaderLocal)));
  CHECK(l1.access(1, Client::Lsu, write(128, 0b1111, Traffic::ShaderLocal)));
  rig.drain();
  CHECK(l1.packets_sent() == 0);
  CHECK(rig.read_latency(0, 0b0011) == params.l1.hit_latency);
  CHECK(l1.access(rig.now(), Client::Lsu, write(256, 0b0001, Traffic::ShaderLocal)));  // this evicts line 128
  rig.drain();
  CHECK(l1.stats().write_backs.value() == 1);
  CHECK(l1.stats().request_bytes.value() == 136);
}

TEST_CASE("a read of two sectors of which one is on the way waits for both and fetches one") {
  Params params;
  MemoryRig rig(params);
  rig.read_latency(kLine, 0b0011, true);
  const Cycle start = rig.now();
  REQUIRE(rig.l1().access(start, Client::Lsu, read(kLine, 1, 0b0001)));
  REQUIRE(rig.l1().access(start + 10, Client::Lsu, read(kLine, 2, 0b0011)));
  rig.drain();
  REQUIRE(rig.answers().size() == 2);
  CHECK(rig.answers()[0].at == start + 160);
  CHECK(rig.answers()[1].at == start + 10 + 160);
  CHECK(rig.l1().sectors_requested() == 2);
  CHECK(rig.l1().stats().misses.total() == 2);
}

TEST_CASE("the least recently used line leaves a full cache and comes back as a miss that is not cold") {
  Params params;
  params.l1.size = 2 * 128;
  MemoryRig rig(params);
  rig.read_latency(0, 1), rig.read_latency(128, 1), rig.read_latency(0, 1), rig.read_latency(256, 1);
  CHECK(rig.read_latency(0, 1) == params.l1.hit_latency);
  CHECK(rig.read_latency(128, 1) == 160);
  CHECK(rig.l1().stats().misses.count(Traffic::RtNode) == 4);
  CHECK(rig.l1().stats().cold_misses.count(Traffic::RtNode) == 3);
}
