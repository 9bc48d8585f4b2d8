// Tests to the cycle and to the line what the L1's allocation and write policies change, and what fills
// change at its ports.
// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "tests/support/catch.h"
#include "tests/timing/memsys/requests.h"

using namespace glint;
using namespace glint::mem;

namespace {}  // namespace

TEST_CASE("a fill keeps its bank from an access in its cycle, and neither another bank nor the next cycle") {
  for (const bool shared : {false, true}) {
    Params params = bare();
    params.l1.fill_takes_access = shared;
    params.l1.ports = 4, params.l1.banks = 4;
    MemoryRig rig(params);
    rig.read_latency(0, 1, true);
    const Cycle start = rig.now();
    rig.run([&](uint32_t, Cycle now) {
      L1Cache& l1 = rig.l1();
      if (now == start) REQUIRE(l1.access(now, Client::Lsu, read(0, 1)));
      if (now == start + kL2Hit - 1) CHECK(l1.access(now, Client::Lsu, read(4 * 128, 2)));
      if (now == start + kL2Hit) {
        CHECK(l1.access(now, Client::Lsu, read(8 * 128, 3)) == !shared);
        CHECK(l1.access(now, Client::Lsu, read(1 * 128, 4)));
      }
      if (now == start + kL2Hit + 1) CHECK(l1.access(now, Client::Lsu, read(12 * 128, 5)));
      return now <= start + kL2Hit ? now + 1 : kNever;
    });
    CHECK(rig.l1().stats().refusals.count(Refusal::Bank) == (shared ? 1 : 0));
  }
}

TEST_CASE(
    "with allocation on a miss, a set whose lines are all on the way refuses another until one has come") {
  Params params = bare();
  params.l1.size = 2 * 128;
  params.l1.allocate = "on_miss";
  MemoryRig rig(params);
  L1Cache& l1 = rig.l1();
  const Cycle start = rig.now();
  bool taken = false;
  for (Address i = 0; i < 3; ++i) rig.read_latency(i * 128, 1, true);
  const Cycle begin = rig.now();
  Cycle at = 0;
  rig.run([&](uint32_t, Cycle now) {
    if (now == begin) REQUIRE(l1.access(now, Client::Lsu, read(0, 1)));
    if (now == begin + 1) REQUIRE(l1.access(now, Client::Lsu, read(128, 2)));
    if (now > begin + 1 && !taken && l1.access(now, Client::Lsu, read(256, 3))) taken = true, at = now;
    return taken ? kNever : now + 1;
  });
  CHECK(at == begin + kL2Hit);
  CHECK(l1.stats().refusals.count(Refusal::SetHeld) == kL2Hit - 2);
  CHECK(start < begin);
  rig.memory().check_drained();
}

TEST_CASE("the L1 tells of each line that takes a place, who asked for it first, and which line made way") {
  for (const char* allocate : {"on_fill", "on_miss"}) {
    CAPTURE(allocate);
    Params params = bare();
    params.l1.size = 2 * 128;
    params.l1.allocate = allocate;
    MemoryRig rig(params);
    L1Cache& l1 = rig.l1();
    REQUIRE(l1.num_lines() == 2);
    std::vector<LineReplaced> told;
    l1.line_replaced().listen([&](const LineReplaced& replaced) { told.push_back(replaced); });
    const auto access = [&](Client client, const Request& request) {
      const Cycle start = rig.now();
      rig.run([&](uint32_t, Cycle now) {
        if (now == start) REQUIRE(l1.access(now, client, request));
        return kNever;
      });
    };
    const Cycle start = rig.now();
    rig.run([&](uint32_t, Cycle now) {  // Two clients wait for the first line.
      if (now == start) REQUIRE(l1.access(now, Client::Lsu, read(0, 7)));
      if (now == start + 1) REQUIRE(l1.access(now, Client::RtUnit, read(0, 8)));
      return now == start ? now + 1 : kNever;
    });
    access(Client::RtUnit, read(128, 9));
    access(Client::Lsu, read(0, 10));  // a hit, which replaces nothing
    access(Client::Lsu, read(256, 11));
    access(Client::Lsu, {128, 1, true, Traffic::ShaderLocal, 12});
    REQUIRE(told.size() == 4);
    CHECK((told[0].by.client == Client::Lsu && told[0].by.token == 7 && !told[0].victim));
    CHECK((told[1].by.client == Client::RtUnit && told[1].by.token == 9 && !told[1].victim));
    CHECK(told[0].place != told[1].place);
    CHECK((told[2].by.token == 11 && told[2].place == told[1].place && told[2].victim == Address{128}));
    CHECK((told[3].by.token == 12 && told[3].place == told[0].place && told[3].victim == Address{0}));
  }
}

TEST_CASE("streaming takes as many misses as MSHRs, whatever the size of the cache") {
  Params params = bare();
  params.l1.size = 2 * 128;
  MemoryRig rig(params);
  for (Token i = 0; i < 8; ++i) CHECK(rig.l1().access(i, Client::Lsu, read(i * 128, i)));
  rig.drain();
  CHECK(rig.l1().stats().refusals.total() == 0);
}

TEST_CASE(
    "allocation on a miss gives up the oldest line when the miss leaves, streaming when the data comes") {
  const auto hits_meanwhile = [](const char* allocate) {
    Params params = bare();
    params.l1.size = 2 * 128;
    params.l1.allocate = allocate;
    MemoryRig rig(params);
    rig.read_latency(0, 1), rig.read_latency(128, 1);
    const Cycle start = rig.now();
    REQUIRE(rig.l1().access(start, Client::Lsu, read(256, 1)));
    REQUIRE(rig.l1().access(start + 1, Client::Lsu, read(0, 2)));
    const uint64_t hits = rig.l1().stats().hits.total();
    rig.drain();
    return hits;
  };
  CHECK(hits_meanwhile("on_fill") == 1);
  CHECK(hits_meanwhile("on_miss") == 0);
}

TEST_CASE("a held line whose first sector has come stays until its last has") {
  Params params = bare();
  params.l1.size = 128;
  params.l1.allocate = "on_miss";
  MemoryRig rig(params);
  rig.read_latency(0, 1, true);  // the L2 has sector 0; sector 1 comes from DRAM
  const Cycle start = rig.now();
  REQUIRE(rig.l1().access(start, Client::Lsu, read(0, 1, 0b11)));
  bool refused = false;
  rig.run([&](uint32_t, Cycle now) {
    if (now == start + kL2Hit + 5) refused = !rig.l1().access(now, Client::Lsu, read(128, 2));
    return now < start + kL2Hit + 5 ? start + kL2Hit + 5 : kNever;
  });
  CHECK(refused);
  CHECK(rig.read_latency(0, 0b11) == params.l1.hit_latency);
}

TEST_CASE("a write allocates the sectors it covers when asked to, and no others") {
  for (const bool allocate : {false, true}) {
    Params params = bare();
    params.l1.write_allocate = allocate;
    MemoryRig rig(params);
    // The write covers half of sector 1.
    REQUIRE(rig.l1().access(0, Client::Lsu, write(0, 0b0011, Traffic::ShaderGlobal, 0x0fff)));
    rig.drain();
    CHECK(rig.l1().packets_sent() == 1);  // the write went through all the same
    CHECK(rig.read_latency(0, 0b0001) == (allocate ? params.l1.hit_latency : kL2Hit));
    CHECK(rig.read_latency(0, 0b0010) == kL2Hit);
  }
}

TEST_CASE("global writes stay in the L1 until eviction when it writes them back") {
  Params params = bare();
  params.l1.global_write_back = true;
  params.l1.size = 2 * 128;
  MemoryRig rig(params);
  REQUIRE(rig.l1().access(0, Client::Lsu, write(0)));
  rig.drain();
  CHECK(rig.l1().packets_sent() == 0);
  CHECK(rig.read_latency(0, 1) == params.l1.hit_latency);
  rig.read_latency(128, 1), rig.read_latency(256, 1);  // these evict line 0
  CHECK(rig.l1().stats().write_backs.value() == 1);
  CHECK(rig.l1().packets_sent() == 3);
  rig.memory().check_drained();
}
