// Tests refresh to the clock: when it begins, what it closes, how long banks wait, and how clocks are
// counted.
// SPDX-License-Identifier: Apache-2.0
#include <string_view>
#include <vector>

#include "memsys/memory_system.h"
#include "tests/support/catch.h"
#include "tests/support/dram_rig.h"
#include "tests/support/memory_rig.h"

using namespace glint;
using namespace glint::mem;

namespace {

// Returns parameters with a refresh every 1000 clocks that takes 200 (all banks) or 60 (one bank).
DramParams refreshed(const char* mode) {
  DramParams p = plain();
  p.refresh = mode;
  p.refi = std::string_view(mode) == "per_bank" ? 16'000 : 1000;  // the 16 banks take turns
  p.rfc = 200, p.rfc_bank = 60;
  return p;
}

uint64_t use(const DramRig& rig, DramUse what) {
  return rig.channel.stats().use.count(what);
}

}  // namespace

TEST_CASE("a request that comes while all banks refresh waits until exactly the refresh's end") {
  DramRig rig(refreshed("all_bank"));
  rig.idle_until(1100);
  CHECK(rig.read_alone(3, 1) == 100 + 15 + 14 + kData);  // the row opens at clock 1200
  rig.idle_until(2216 - kEdge);                          // the row that was opened must be closed first
  CHECK(rig.read_alone(3, 1) == kEdge + 15 + 14 + kData);
  rig.idle_until(3216 - kEdge - 1);
  CHECK(rig.read_alone(3, 1) == kEdge + 1 + 15 + 14 + kData);
}

TEST_CASE("a refresh waits for an open row to be closed, and no longer") {
  DramRig rig(refreshed("all_bank"));
  // The row is activated at 980, is closed at 1010 at the earliest, and is refreshed from 1026 on.
  rig.add(980 - kEdge, 0, 1, false, 1);
  rig.add(1100, 5, 1, false, 2);
  CHECK(rig.run()[2] == 980 + 30 + 16 + 200 + 15 + 14 + kData);
  CHECK(rig.channel.stats().refreshes.value() == 1);
}

TEST_CASE("a row that was open is closed by a refresh, and the bank opens it again") {
  for (const auto& [mode, opens] : {std::pair{"none", 1u}, {"all_bank", 2u}}) {
    DramRig rig(refreshed(mode));
    rig.idle_until(500);
    rig.read_alone(0, 1);
    rig.idle_until(1500);
    rig.read_alone(0, 1);
    CHECK(rig.channel.stats().activates.value() == opens);
    CHECK(rig.channel.stats().precharges.value() == 0);
  }
}

TEST_CASE("a refresh takes the row from a request that waits for its column command") {
  DramRig rig(refreshed("all_bank"));
  rig.add(990 - kEdge, 0, 1, false, 1);  // the row opens at 990, and the read would be at 1005
  CHECK(rig.run()[1] == 990 + 30 + 16 + 200 + 15 + 14 + kData);
  CHECK(rig.channel.stats().reopened.value() == 1);
  CHECK(rig.channel.stats().activates.value() == 2);

  DramRig sooner(refreshed("all_bank"));
  sooner.add(984 - kEdge, 0, 1, false, 1);  // the row opens at 984; the read at 999 is before the refresh
  CHECK(sooner.run()[1] == 984 + 15 + 14 + kData);
  CHECK(sooner.channel.stats().reopened.value() == 0);
}

TEST_CASE("one bank's refresh leaves the others alone, and the banks take turns") {
  DramRig rig(refreshed("per_bank"));  // bank 0 is refreshed at 1000, bank 1 at 2000
  rig.idle_until(1010);
  rig.add(1010, 0, 1, false, 1);
  rig.add(1010, 1, 1, false, 2);
  auto at = rig.run();
  CHECK(at[1] == 1060 + 15 + 14 + kData);
  CHECK(at[2] == 1010 + kEdge + 15 + 14 + kData);
  rig.idle_until(2010);
  rig.add(2010, 0, 1, false, 3);
  rig.add(2010, 1, 1, false, 4);
  at = rig.run();
  CHECK(at[3] == 2010 + kEdge + 14 + kData);  // its row is still open
  CHECK(at[4] == 2000 + 16 + 60 + 15 + 14 + kData);
}

TEST_CASE("a bank's turn comes round after as many refreshes as there are banks") {
  DramRig rig(refreshed("per_bank"));
  rig.idle_until(17'010);
  CHECK(rig.read_alone(0, 1) == 50 + 15 + 14 + kData);
  CHECK(rig.channel.stats().refreshes.value() == 17);
}

TEST_CASE("channels refresh one after another") {
  Params params = bare();
  params.dram = refreshed("all_bank");
  params.dram.channels = 4;
  stats::Group root(nullptr, "test");
  MemorySystem memory(params, 1, 1000.0, &root);
  memory.finish(600);  // refreshes are due at 250, 500, 750 and 1000
  std::vector<uint64_t> refreshes;
  for (uint32_t i = 0; i < 4; ++i) refreshes.push_back(memory.partition(i).dram().stats().refreshes.value());
  CHECK(refreshes == std::vector<uint64_t>{1, 1, 0, 0});
}

TEST_CASE("refreshes happen on time in a channel that nobody asks, and cost it nothing") {
  DramRig rig(refreshed("all_bank"));
  rig.channel.finish(10'500);
  CHECK(rig.channel.stats().refreshes.value() == 10);
  CHECK(use(rig, DramUse::Idle) == 10'500);
  CHECK(rig.channel.stats().active_clocks.value() == 0);
}

TEST_CASE("clocks in which requests wait for a refresh are counted as refresh, and no others") {
  DramRig rig(refreshed("all_bank"));
  rig.add(1100, 3, 1, false, 1);
  rig.run();
  rig.channel.finish(1500);
  CHECK(use(rig, DramUse::Refresh) == 1200 - 1101);
  CHECK(use(rig, DramUse::ColumnWait) == 15);
  CHECK(use(rig, DramUse::Data) == kData);
  CHECK(use(rig, DramUse::RowWait) == 0);
  CHECK(rig.channel.stats().use.total() == 1500);
}

TEST_CASE("a stream loses the share of refresh and of opening its rows again, and nothing else") {
  const auto clocks = [](const char* mode) {
    DramRig rig(refreshed(mode));
    Cycle now = 0;
    for (uint32_t i = 0; i < 4000; ++i) {
      while (rig.channel.full()) now = rig.channel.next_command(), rig.channel.advance(now);
      rig.add(now, i % 4, 1, false, 0);
    }
    return rig.run()[0];
  };
  const Cycle without = clocks("none"), with = clocks("all_bank");
  CHECK(without >= 4000 * kData);
  // There are 16,000 clocks of data in pieces of at most 800 less the drain, which gives at least 20
  // refreshes. Each takes 200 clocks, and at most tRAS + tRP + tRCD + tCL more.
  CHECK(with > without + 20 * 200);
  CHECK(with < without + 22 * (200 + 30 + 16 + 15 + 14 + 20));
}

TEST_CASE("while the bus turns, waiting column commands are counted as turnaround") {
  DramRig rig(plain());
  rig.read_alone(0, 1), rig.read_alone(1, 1);
  rig.add(9000, 0, 1, true);
  rig.add(9000, 1, 1, false, 2);
  rig.run();
  rig.channel.finish(10'000);
  // The write goes at 9001 and moves data for 4 clocks by the split's count. The read goes at 9001 + WL +
  // data + tWTR.
  CHECK(use(rig, DramUse::Turnaround) == (4 + kData + 8) - kData);
  CHECK(rig.channel.stats().use.total() == 10'000);
}

TEST_CASE("the bus stays idle for as many clocks as it takes to turn from reading to writing") {
  const auto third = [](uint32_t turn) {
    DramParams params = plain();
    params.bus_turn = turn;
    DramRig rig(params);
    rig.read_alone(0, 1), rig.read_alone(1, 1), rig.read_alone(2, 1);
    rig.add(9000, 0, 1, false, 1);
    rig.add(9000, 1, 1, true);
    rig.add(9025, 2, 1, false, 3);  // comes after the write
    return rig.run()[3];
  };
  CHECK(third(3) == third(2) + 1);
  CHECK(third(0) == third(2) - 2);
}

TEST_CASE(
    "an activate of two clocks keeps the next command off a single bus, and only rows off a bus for rows") {
  const auto second = [](uint32_t clocks, bool dual) {
    DramParams params = plain();
    params.activate_clocks = clocks, params.dual_command_bus = dual;
    params.rrd_s = params.rrd_l = 1;
    DramRig rig(params);
    rig.read_alone(1, 1);
    rig.add(9000, 0, 1, false, 1);  // the row opens at 9001
    rig.add(9001, 1, 1, false, 2);  // its row is open, so the read is at 9002 when the bus is free
    return rig.run()[2];
  };
  const Cycle free = 9002 + 14 + kData;
  CHECK(second(1, false) == free);
  CHECK(second(3, false) == free + 2);
  CHECK(second(3, true) == free);
}
