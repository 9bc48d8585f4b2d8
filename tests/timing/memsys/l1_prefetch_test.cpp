// Tests how the L1 treats prefetches, and how it counts what they were good for.
// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "tests/support/catch.h"
#include "tests/timing/memsys/requests.h"

using namespace glint;
using namespace glint::mem;

namespace {

Request prefetch(Address line, uint8_t sectors = 1) {
  return {line, sectors, false, Traffic::RtPrefetch};
}
struct Step {
  Cycle at;
  Request request;
};

// Makes the requests at their cycles. Returns the answers.
std::vector<Answered> answers(MemoryRig& rig, std::vector<Step> steps) {
  const Cycle start = rig.now();
  size_t next = 0;
  rig.run([&](uint32_t, Cycle now) {
    for (; next < steps.size() && start + steps[next].at == now; ++next)
      REQUIRE(rig.l1().access(now, Client::RtUnit, steps[next].request));
    return next < steps.size() ? start + steps[next].at : kNever;
  });
  return rig.answers();
}
}  // namespace

TEST_CASE("a prefetched sector is a hit for the read that comes later, and nobody is told of the prefetch") {
  MemoryRig rig(bare());
  const auto got = answers(rig, {{0, prefetch(0)}, {2000, read(0, 7)}});
  REQUIRE(got.size() == 1);
  CHECK(got[0].token == 7);
  CHECK(got[0].at == 2000 + bare().l1.hit_latency);
  const PrefetchStats& stats = rig.l1().stats().prefetch;
  CHECK(stats.sectors.value() == 1);
  CHECK(stats.useful.value() == 1);
  CHECK(stats.late.value() == 0);
  CHECK(stats.unused.value() == 0);
}

TEST_CASE("a read that meets a prefetch on its way waits for it, and the prefetch counts as late") {
  MemoryRig plain(bare()), rig(bare());
  const auto alone = answers(plain, {{0, read(0, 7)}});
  const auto got = answers(rig, {{0, prefetch(0)}, {20, read(0, 7)}, {21, read(0, 8)}});
  REQUIRE(got.size() == 2);
  CHECK(got[0].at == alone[0].at);  // The sector comes when it would have come for a read in cycle 0.
  const PrefetchStats& stats = rig.l1().stats().prefetch;
  CHECK(stats.late.value() == 1);
  CHECK(stats.useful.value() == 0);
  CHECK(rig.l1().stats().pending_hits.count(Traffic::RtNode) == 2);
}

TEST_CASE("sectors that leave the cache unread are unused, and a read of them later is an ordinary miss") {
  Params params = bare();
  params.l1.size = 256, params.l1.ways = 0;
  MemoryRig rig(params);
  const auto got = answers(rig, {{0, prefetch(0, 3)},
                                 {1000, read(0, 1, 1)},
                                 {2000, read(128, 2)},
                                 {3000, read(256, 3)},
                                 {4000, read(384, 4)},
                                 {5000, read(0, 5, 3)}});
  CHECK(got.size() == 5);
  const L1Stats& stats = rig.l1().stats();
  CHECK(stats.prefetch.sectors.value() == 2);
  CHECK(stats.prefetch.useful.value() == 1);
  CHECK(stats.prefetch.unused.value() == 1);
  CHECK(stats.misses.count(Traffic::RtNode) == 4);
}

TEST_CASE("a prefetch of what is there or on its way asks nobody, and a full MSHR refuses one") {
  Params params = bare();
  params.l1.mshr_entries = 1;
  MemoryRig rig(params);
  const Cycle start = rig.now();
  rig.run([&](uint32_t, Cycle now) {
    L1Cache& l1 = rig.l1();
    if (now == start) {
      CHECK(l1.access(now, Client::RtUnit, read(0, 1)));
      return now + 1;
    }
    if (now == start + 1) {
      CHECK(l1.access(now, Client::RtUnit, prefetch(0)));
      return now + 1;
    }
    if (now == start + 2) CHECK_FALSE(l1.access(now, Client::RtUnit, prefetch(128)));
    if (now == start + 2000) CHECK(l1.access(now, Client::RtUnit, prefetch(0)));
    return now < start + 2000 ? start + 2000 : kNever;
  });
  const L1Stats& stats = rig.l1().stats();
  CHECK(stats.prefetch.sectors.value() == 0);
  CHECK(stats.pending_hits.count(Traffic::RtPrefetch) == 1);
  CHECK(stats.hits.count(Traffic::RtPrefetch) == 1);
  CHECK(stats.refusals.count(Refusal::MshrFull) == 1);
}
