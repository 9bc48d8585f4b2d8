// Tests limits of L1, network and L2 that show only in one cycle or byte.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <map>
#include <vector>

#include "tests/support/catch.h"
#include "tests/timing/memsys/requests.h"

using namespace glint;
using namespace glint::mem;

namespace {

Request request(Address line, uint8_t sectors, Token token, bool write, Traffic traffic) {
  return {line, sectors, write, traffic, token};
}
Request atomic(Address line, Token token, uint8_t sectors = 1) {
  return request(line, sectors, token, false, Traffic::ShaderAtomic);
}

// Returns the cycles from the request to its token, for sectors that the L2 holds.
Cycle l2_latency(const Params& params, const Request& request) {
  MemoryRig rig(params);
  rig.read_latency(kLine, 0b1111, true);
  const Cycle start = rig.now();
  REQUIRE(rig.l1().access(start, Client::Lsu, request));
  rig.drain();
  return rig.answers().back().at - start;
}

// Returns the cycles from the start to each token. All are asked for in the first cycle, token i by core i.
std::vector<Cycle> together(const Params& params, const std::vector<Request>& requests) {
  MemoryRig rig(params, uint32_t(requests.size()));
  for (uint32_t core = 0; core < requests.size(); ++core)
    REQUIRE(rig.l1(core).access(0, Client::Lsu, requests[core]));
  rig.drain();
  std::vector<Cycle> at(requests.size());
  for (const Answered& a : rig.answers()) at[a.token] = a.at;
  return at;
}

}  // namespace

TEST_CASE("writes and atomics leave the L1 at its miss latency, as reads do") {
  for (const Request& what :
       {read(kLine, 1), atomic(kLine, 1), request(kLine, 1, 0, true, Traffic::ShaderGlobal)}) {
    MemoryRig rig(bare());
    REQUIRE(rig.l1().access(0, Client::Lsu, what));
    CHECK(rig.l1().next_event(0) == bare().l1.miss_latency);
  }
}

TEST_CASE("a port is as wide as it says, to the byte") {
  const auto narrower = [](uint32_t NocParams::*port, const Request& request) {
    Params wide = bare();
    for (uint32_t NocParams::*p : {&NocParams::core_request_bytes, &NocParams::core_reply_bytes,
                                   &NocParams::partition_request_bytes, &NocParams::partition_reply_bytes})
      wide.noc.*p = 400;
    wide.noc.*port = 72;  // two sectors and a header take 72 bytes
    Params narrow = wide;
    narrow.noc.*port = 71;
    CHECK(l2_latency(wide, request) == l2_latency(
                                           [&] {
                                             Params p = wide;
                                             p.noc.*port = 400;
                                             return p;
                                           }(),
                                           request));
    return l2_latency(narrow, request) - l2_latency(wide, request);
  };
  CHECK(narrower(&NocParams::core_reply_bytes, read(kLine, 1, 0b11)) == 1);
  CHECK(narrower(&NocParams::partition_reply_bytes, read(kLine, 1, 0b11)) == 1);
  CHECK(narrower(&NocParams::core_request_bytes, atomic(kLine, 1, 0b11)) == 1);
  CHECK(narrower(&NocParams::partition_request_bytes, atomic(kLine, 1, 0b11)) == 1);
}

TEST_CASE("an atomic takes its interval of the slice for each sector") {
  Params params = bare();
  CHECK(l2_latency(params, atomic(kLine, 1)) == kL2Hit + 2 - 1);
  params.l2.atomic_interval = 5;
  CHECK(l2_latency(params, atomic(kLine, 1)) == kL2Hit + 5 - 1);
  // A packet of two sectors, and its reply, take one more cycle of each 40-byte port.
  CHECK(l2_latency(params, atomic(kLine, 1, 0b11)) == kL2Hit + 2 * 5 - 1 + 2);
}

TEST_CASE("lanes of an atomic that take turns take the slice's time for each, and their own parts of it") {
  Params params = bare();
  params.l2.atomic_interval = 5;
  Request turns = atomic(kLine, 1);
  turns.atomic = {.lanes = 32, .turns = 3};
  // Data of three sectors are on the way there: 104 bytes take two more cycles of the 40-byte port than 40
  // bytes.
  CHECK(l2_latency(params, turns) == kL2Hit + 3 * 5 - 1 + 2);
  params.l2.atomic_lane_interval = 0.125;
  CHECK(l2_latency(params, turns) == kL2Hit + 3 * 5 + 4 - 1 + 2);
  turns.atomic.lanes = 33;  // an eighth of a cycle more takes a whole cycle
  CHECK(l2_latency(params, turns) == kL2Hit + 3 * 5 + 5 - 1 + 2);
  turns.atomic = {.lanes = 0, .turns = 1};  // there are never fewer turns than sectors
  turns.sectors = 0b11;
  CHECK(l2_latency(params, turns) == kL2Hit + 2 * 5 - 1 + 2);
}

TEST_CASE("a turn of an atomic that has all words of its sector takes its own time") {
  Params params = bare();
  params.l2.atomic_interval = 5;
  params.l2.atomic_whole_interval = 3;
  for (const uint8_t lanes : {uint8_t{1}, uint8_t{7}, uint8_t{8}}) {
    Request request = atomic(kLine, 1);
    request.atomic = {.lanes = lanes, .turns = 1};
    CHECK(l2_latency(params, request) == kL2Hit + (lanes == 8 ? 3 : 5) - 1);
    request.atomic.adds_floats = true;
    CHECK(l2_latency(params, request) == kL2Hit + (lanes == 8 ? 3 : 5) - 1);
    Params slow = params;
    slow.l2.atomic_float_interval = 7;
    CHECK(l2_latency(slow, request) == kL2Hit + 7 - 1);
  }
}

TEST_CASE("reads take their visit or the time of their sectors, whichever is longer") {
  Params params = bare();
  params.l2.sectors_per_cycle = 2;
  const Cycle one = l2_latency(params, read(kLine, 1)), two = l2_latency(params, read(kLine, 1, 0b11));
  params.l2.read_interval = 1.5;
  params.l2.read_visit = 4;
  CHECK(l2_latency(params, read(kLine, 1)) == one + 4 - 1);
  CHECK(l2_latency(params, read(kLine, 1, 0b11)) == two + 4 - 1);
  params.l2.read_visit = 1.25;
  CHECK(l2_latency(params, read(kLine, 1)) == one + 2 - 1);
  CHECK(l2_latency(params, read(kLine, 1, 0b11)) == two + 3 - 1);
}

TEST_CASE("an atomic at another line than the one before it takes its visit of the slice") {
  Params params = bare();
  params.l2.atomic_visit = 7;
  CHECK(l2_latency(params, atomic(kLine, 1)) == kL2Hit + 2 - 1 + 7);
  for (const Address second : {kLine, kLine + 128}) {
    MemoryRig rig(params, 2);
    rig.read_latency(kLine, 0b1111, true);
    rig.read_latency(kLine + 128, 0b1111, true);
    const size_t before = rig.answers().size();
    REQUIRE(rig.l1(0).access(rig.now(), Client::Lsu, atomic(kLine, 1)));
    REQUIRE(rig.l1(1).access(rig.now(), Client::Lsu, atomic(second, 2)));
    rig.drain();
    REQUIRE(rig.answers().size() == before + 2);
    CHECK(rig.answers()[before + 1].at - rig.answers()[before].at == (second == kLine ? 2 : 2 + 7));
  }
}

TEST_CASE("an atomic that returns old values takes its further part of the slice for each lane") {
  Params params = bare();
  params.l2.atomic_interval = 1.5;
  Request request = atomic(kLine, 1);
  request.atomic = {.lanes = 8, .turns = 2};
  // Data of two sectors are on the way there, which take one more cycle of the 40-byte port.
  const Cycle without = l2_latency(params, request);
  CHECK(without == kL2Hit + 3 - 1 + 1);
  params.l2.atomic_answer_interval = 0.25;
  CHECK(l2_latency(params, request) == without + 2);
}

TEST_CASE("every second partition's DRAM is as much farther as its parameter says") {
  Params params = bare();
  params.dram.channels = 2;
  const auto latencies = [&] {
    std::array<Cycle, 8> out{};
    for (size_t chunk = 0; chunk < out.size(); ++chunk) {
      MemoryRig rig(params);
      out[chunk] = rig.read_latency(chunk * params.interleave, 1);
    }
    return out;
  };
  const auto near = latencies();
  params.dram.far_latency = 190;
  const auto far = latencies();
  std::map<Cycle, int> differences;
  for (size_t chunk = 0; chunk < far.size(); ++chunk) ++differences[far[chunk] - near[chunk]];
  CHECK(differences == std::map<Cycle, int>{{0, 4}, {190, 4}});
}

TEST_CASE("a credit is back after the way back, not a cycle before") {
  Params params = bare();
  params.noc.credits = 1;
  params.hash = "none";
  params.dram.channels = 1;
  MemoryRig rig(params);
  rig.set_window(1);  // messages are seen when they come
  for (Address i = 0; i < 2; ++i) rig.read_latency(i * 128, 1, true);
  const Cycle start = rig.now();
  REQUIRE(rig.l1().access(start, Client::Lsu, read(0, 0)));
  REQUIRE(rig.l1().access(start + 1, Client::Lsu, read(128, 1)));
  rig.drain();
  CHECK(rig.answers().back().at - start == (20 + 49) + 49 + 49 + 42 + 49);
}

TEST_CASE("a dirty line that is evicted goes to DRAM after the way there") {
  for (const uint32_t way : {1u, 100u, 37u}) {
    Params params = bare();
    params.dram.channels = 1, params.dram.latency = way;
    params.l2.slice_size = 128, params.l2.ways = 1;
    MemoryRig rig(params);
    rig.set_window(1);
    rig.read_latency(0, 1, true);
    const Cycle start = rig.now();
    REQUIRE(rig.l1().access(start, Client::Lsu, request(128, 1, 0, true, Traffic::ShaderGlobal)));
    Cycle seen = 0;
    rig.run([&](uint32_t, Cycle now) {
      if (!seen && rig.memory().partition(0).dram().stats().requests.value() == 1) seen = now;
      return seen || now > start + 10'000 ? kNever : now + 1;
    });
    CHECK(seen == start + 20 + 49 + way + 1);  // the slice serves it, it travels, and the next cycle sees it
  }
}

TEST_CASE("a slice whose MSHRs are in use serves no further miss until one has come back") {
  const auto later = [](uint32_t entries) {
    Params params = bare();
    params.dram.channels = 1, params.l2.mshr_entries = entries;
    const std::vector<Cycle> at = together(params, {read(0, 0), read(128, 1)});
    return at[1] - at[0];
  };
  CHECK(later(2) < 20);
  CHECK(later(1) > 100);
}

TEST_CASE("an MSHR of a slice merges up to its limit, the first read included") {
  const auto later = [](uint32_t merges) {
    Params params = bare();
    params.dram.channels = 1, params.l2.mshr_merges = merges;
    const std::vector<Cycle> at = together(params, {read(0, 0), read(0, 1), read(0, 2)});
    return at[2] - at[0];
  };
  CHECK(later(3) <= 2);
  CHECK(later(2) >= 42);  // it is served again after the fill, with the slice's latency
}

TEST_CASE("the way to DRAM holds as many sectors as it says") {
  const auto blocked = [](uint32_t places) {
    Params params = bare();
    params.dram.channels = 1, params.l2.dram_queue = places;
    MemoryRig rig(params, 3);
    for (uint32_t core = 0; core < 3; ++core)
      REQUIRE(rig.l1(core).access(0, Client::Lsu, read(core * 128, core, 0b1111)));
    rig.drain();
    return rig.memory().partition(0).slice(0).stats().cycles.count(SliceCycle::QueueFull) > 0;
  };
  CHECK_FALSE(blocked(12));
  CHECK(blocked(11));
}

TEST_CASE(
    "latencies of reads are counted by class and bucket, and percentiles are the upper ends of buckets") {
  for (Cycle latency = 0; latency < 5000; ++latency) {
    const uint32_t bucket = Latencies::bucket_of(latency);
    CHECK(Latencies::low_of(bucket) <= latency);
    CHECK(latency < Latencies::low_of(bucket + 1));
    if (latency >= 16)
      CHECK(8 * (Latencies::low_of(bucket + 1) - Latencies::low_of(bucket)) <= Latencies::low_of(bucket));
  }
  CHECK(Latencies::bucket_of(~Cycle{0} >> 1) == Latencies::kBuckets - 1);
  stats::Group root(nullptr, "test");
  LatencyStats stats(&root, "latency", "Reads.");
  Latencies a, b;
  stats.add(a), stats.add(b);
  for (Cycle i = 0; i < 90; ++i) a.add(Traffic::RtNode, 20);
  for (Cycle i = 0; i < 9; ++i) b.add(Traffic::RtNode, 160);
  b.add(Traffic::RtNode, 1000);
  CHECK(stats.reads(Traffic::RtNode) == 100);
  CHECK(stats.reads(Traffic::ShaderGlobal) == 0);
  CHECK(stats.percentile(Traffic::RtNode, 50) == 21);  // the bucket is 20 to 21
  CHECK(stats.percentile(Traffic::RtNode, 90) == 21);
  CHECK(stats.percentile(Traffic::RtNode, 91) == 175);  // the bucket is 160 to 175
  CHECK(stats.percentile(Traffic::RtNode, 99) == 175);
  CHECK(stats.percentile(Traffic::RtNode, 100) == 1023);
  CHECK(stats.percentile(Traffic::ShaderGlobal, 50) == 0);
}

TEST_CASE("the L1 times hits, misses, merged reads and atomics, each under its class") {
  MemoryRig rig(bare());
  rig.read_latency(kLine, 1, true);
  const Cycle start = rig.now();
  REQUIRE(rig.l1().access(start, Client::Lsu, read(kLine, 1)));
  // This read merges.
  REQUIRE(rig.l1().access(start + 10, Client::Lsu, request(kLine, 1, 2, false, Traffic::ShaderGlobal)));
  rig.drain();
  // This read hits.
  REQUIRE(rig.l1().access(rig.now(), Client::Lsu, request(kLine, 1, 3, false, Traffic::ShaderLocal)));
  rig.drain();
  REQUIRE(rig.l1().access(rig.now(), Client::Lsu, atomic(kLine, 4)));
  rig.drain();
  const Latencies& latencies = rig.l1().latencies();
  CHECK(latencies.cycles(Traffic::RtNode) == kL2Hit);
  CHECK(latencies.cycles(Traffic::ShaderGlobal) == kL2Hit - 10);
  CHECK(latencies.cycles(Traffic::ShaderLocal) == 20);
  CHECK(latencies.cycles(Traffic::ShaderAtomic) == kL2Hit + 1);
  rig.memory().check_drained();
}
