// Tests DRAM commands to the clock: row hits, misses, conflicts, windows and turnarounds.
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.h"
#include "tests/support/dram_rig.h"

using namespace glint;
using namespace glint::mem;

TEST_CASE("a closed bank needs activate and read, an open row only read, a conflict precharge too") {
  DramRig rig(plain());
  CHECK(rig.read_alone(3, 1) == kEdge + 15 + 14 + kData);
  CHECK(rig.read_alone(3, 1) == kEdge + 14 + kData);
  CHECK(rig.read_alone(3, 2) == kEdge + 16 + 15 + 14 + kData);
  CHECK(rig.channel.stats().activates.value() == 2);
  CHECK(rig.channel.stats().precharges.value() == 1);
  CHECK(rig.channel.stats().row_hits.value() == 1);
}

TEST_CASE("each kind of graphics memory has the latency and the spacing of its row") {
  struct Expected {
    const char* kind;
    Cycle closed, open, two_banks, one_bank;  // clocks: to the end of a read, and between two row hits
  };
  // GDDR6X: 15.4 ns, 13.7 ns and 2 clocks of 0.421 ns are 37 + 33 + 2. GDDR7: 17.1 ns, 13.7 ns and 2 clocks
  // of 0.571 ns are 30 + 24 + 2.
  for (const Expected& want : {Expected{"gddr6_14000", 27 + 24 + 2, 24 + 2, 2, 4},
                               Expected{"gddr6x_19000", 37 + 33 + 2, 33 + 2, 2, 4},
                               Expected{"gddr7_28000", 30 + 24 + 2, 24 + 2, 2, 4}}) {
    INFO(want.kind);
    DramParams params;
    apply_dram_kind(params, want.kind);
    params.refresh = "none";
    DramRig rig(params, params.clock_mhz);
    CHECK(rig.read_alone(0, 1) == kEdge + want.closed);
    CHECK(rig.read_alone(0, 1) == kEdge + want.open);
    rig.read_alone(1, 1);
    for (const auto& [second, spacing] : {std::pair{1u, want.two_banks}, {0u, want.one_bank}}) {
      rig.add(rig.idle(), 0, 1, false, 1);
      rig.add(rig.idle(), second, 1, false, 2);
      auto at = rig.run();
      CHECK(at[2] - at[1] == spacing);
      rig.idle_until(at[2] + 1000);
    }
  }
}

TEST_CASE("row hits of one bank group are spaced by the long column delay, of two by the short one") {
  for (const auto& [second, spacing] : {std::pair{0u, 6}, {4u, 6}, {1u, 4}}) {
    DramRig rig(plain());
    rig.read_alone(0, 1), rig.read_alone(second, 1);
    rig.add(9000, 0, 1, false, 1);
    rig.add(9000, second, 1, false, 2);
    auto at = rig.run();
    CHECK(at[2] - at[1] == Cycle(spacing));
  }
}

TEST_CASE("a bank that was just opened is not closed before tRAS") {
  DramRig rig(plain());
  rig.add(0, 0, 1, false, 1);
  rig.add(0, 0, 2, false, 2);
  auto at = rig.run();
  CHECK(at[1] == kEdge + 15 + 14 + kData);
  // The precharge is at 1 + 30 and the activate 16 later, which agrees with tRC = 46.
  CHECK(at[2] == kEdge + 30 + 16 + 15 + 14 + kData);
}

TEST_CASE("a long tRC holds back the next activate of the bank") {
  DramParams params = plain();
  params.rc = 60;
  DramRig rig(params);
  rig.add(0, 0, 1, false, 1);
  rig.add(0, 0, 2, false, 2);
  CHECK(rig.run()[2] == kEdge + 60 + 15 + 14 + kData);
}

TEST_CASE("activates are spaced by tRRD and the fifth waits for the window of four") {
  DramParams params = plain();
  params.dual_command_bus = true;
  DramRig rig(params);
  for (uint32_t i = 0; i < 5; ++i)
    rig.add(0, i, 1, false, i + 1);  // banks 0 to 3 are in groups 0 to 3, and bank 4 is in group 0
  auto at = rig.run();
  const Cycle first = kEdge + 15 + 14 + kData;
  CHECK(at[1] == first);
  CHECK(at[2] == first + 5);
  CHECK(at[3] == first + 10);
  CHECK(at[4] == first + 15);
  CHECK(at[5] == first + 40);
}

TEST_CASE("on a single command bus an activate gives way to a column command of the same clock") {
  DramRig rig(plain());
  for (uint32_t i = 0; i < 4; ++i) rig.add(0, i, 1, false, i + 1);
  // The fourth activate would go out at clock 16, as the first read does.
  CHECK(rig.run()[4] == kEdge + 15 + 1 + 15 + 14 + kData);
}

TEST_CASE("two activates of one bank group are spaced by the long tRRD") {
  DramRig rig(plain());
  rig.add(0, 0, 1, false, 1);
  rig.add(0, 4, 1, false, 2);
  auto at = rig.run();
  CHECK(at[2] - at[1] == 7);
}

TEST_CASE("a read after a write waits for the data and tWTR of its bank group") {
  for (const auto& [second, wtr] : {std::pair{0u, 10u}, {1u, 8u}}) {
    DramRig rig(plain());
    rig.read_alone(0, 1), rig.read_alone(second, 1);
    rig.add(9000, 0, 1, true);
    rig.add(9000, second, 1, false, 2);
    CHECK(rig.run()[2] == 9000 + kEdge + 4 + kData + wtr + 14 + kData);
    CHECK(rig.channel.stats().turnarounds.value() == 2);
  }
}

TEST_CASE("a write after a read waits until the bus can turn") {
  DramRig rig(plain());
  rig.read_alone(0, 1), rig.read_alone(1, 1);
  rig.add(9000, 0, 1, false, 1);
  rig.add(9000, 1, 1, true);
  rig.add(9000, 2, 1, false, 3);  // its read waits for the activate and for tWTR after the write
  auto at = rig.run();
  const Cycle write_at = 9000 + kEdge + 14 + kData + 2 - 4;
  CHECK(at[3] == write_at + 4 + kData + 8 + 14 + kData);
}

TEST_CASE("a written row is not closed before its write recovery") {
  DramRig rig(plain());
  rig.read_alone(0, 1);
  rig.add(9000, 0, 1, true);
  rig.add(9000, 0, 2, false, 2);
  CHECK(rig.run()[2] == 9000 + kEdge + 4 + kData + 17 + 16 + 15 + 14 + kData);
}

TEST_CASE("a row that was read is not closed before tRTP, and a short tRC does not close it before tRAS") {
  DramParams params = plain();
  params.ras = 20, params.rc = 30;  // tRC is less than tRAS + tRP
  DramRig rig(params);
  rig.read_alone(0, 1);
  rig.add(9000, 0, 1, false, 1);
  rig.add(9000, 0, 2, false, 2);
  CHECK(rig.run()[2] == 9000 + kEdge + 5 + 16 + 15 + 14 + kData);
  rig.idle_until(20'000);
  rig.add(20'000, 1, 1, false, 3);
  rig.add(20'000, 1, 2, false, 4);
  CHECK(rig.run()[4] == 20'000 + kEdge + 20 + 16 + 15 + 14 + kData);  // tRCD + tRTP are over at the same time
}

TEST_CASE("a bank is not closed before tRAS where tRC is shorter than tRAS and tRP") {
  DramParams params = plain();
  params.rc = 30;
  DramRig rig(params);
  rig.add(0, 0, 1, false, 1);
  rig.add(0, 0, 2, false, 2);
  CHECK(rig.run()[2] == kEdge + 30 + 16 + 15 + 14 + kData);
}

TEST_CASE("a row that is opened for a write takes the write's tRCD") {
  DramRig rig(plain());
  rig.add(0, 0, 1, true);
  rig.add(0, 0, 1, false, 2);
  CHECK(rig.run()[2] == kEdge + 9 + 4 + kData + 10 + 14 + kData);
}

TEST_CASE("an activate keeps other activates and precharges off the command bus for its clocks") {
  DramParams params = plain();
  params.dual_command_bus = true;
  params.activate_clocks = 6;
  DramRig rig(params);
  rig.add(0, 0, 1, false, 1);
  rig.add(0, 1, 1, false, 2);
  auto at = rig.run();
  CHECK(at[2] - at[1] == 6);  // tRRD is 5
  rig.idle_until(9000);
  rig.add(9000, 2, 1, false, 3);  // opens its row, and then bank 0 closes one
  rig.add(9000, 0, 2, false, 4);
  CHECK(rig.run()[4] == 9000 + kEdge + 6 + 16 + 15 + 14 + kData);
}

TEST_CASE("FR-FCFS serves a younger row hit first and FCFS does not") {
  const auto order = [](const char* scheduler) {
    DramParams params = plain();
    params.scheduler = PolicyChoice<DramScheduler>(scheduler);
    DramRig rig(params);
    rig.read_alone(0, 1);
    rig.add(9000, 0, 1, false, 1);
    rig.add(9000, 0, 2, false, 2);
    rig.add(9000, 0, 1, false, 3);
    auto at = rig.run();
    return at[3] < at[2];
  };
  CHECK(order("frfcfs"));
  CHECK_FALSE(order("fcfs"));
}

TEST_CASE("a stream of row hits over bank groups keeps the data bus full") {
  DramRig rig(plain());
  for (uint32_t bank = 0; bank < 4; ++bank) rig.read_alone(bank, 1);
  const uint64_t busy = rig.channel.stats().busy_clocks.value();
  for (uint32_t i = 0; i < 64; ++i) rig.add(9000, i % 4, 1, false, i + 1);
  auto at = rig.run();
  CHECK(at[64] - at[1] == 63 * kData);
  CHECK(rig.channel.stats().busy_clocks.value() - busy == 64 * kData);
}

TEST_CASE("every command clock is attributed and the ratios follow their definitions") {
  DramRig rig(plain());
  rig.add(0, 0, 1, false, 1);
  rig.add(0, 1, 1, false, 2);
  rig.run();
  rig.channel.finish(1000);
  const DramStats& s = rig.channel.stats();
  CHECK(s.clocks.value() == 1000);
  CHECK(s.use.total() == 1000);
  CHECK(s.use.count(DramUse::Data) == 2 * kData);
  CHECK(s.utilisation.value() == Approx(0.008));
  // At clock 1 both banks take a request; their reads are at 16 and 21. Bank 0's row may run its tRC to clock
  // 47, and bank 1's to 52.
  CHECK(s.any_bank_clocks.value() == 20);
  CHECK(s.bank_clocks.value() == 15 + 20);
  CHECK(s.active_clocks.value() == 51);
  CHECK(s.efficiency.value() == Approx(8.0 / 51.0));
  // Clocks 1 to 15 wait for tRCD, and clock 20 waits for the second read. The data of both start with their
  // commands.
  CHECK(s.use.count(DramUse::ColumnWait) == 15 + 1);
  CHECK(s.use.count(DramUse::RowWait) == 0);
  CHECK(s.use.count(DramUse::Idle) == 1000 - 8 - 16);
  rig.add(2000, 0, 2, false, 3);
  rig.run();
  CHECK(s.use.count(DramUse::RowWait) == 16);  // clocks from precharge to activate
}

TEST_CASE("a full queue says so and frees a place with each column command") {
  DramParams params = plain();
  params.queue = 2;
  DramRig rig(params);
  rig.add(0, 0, 1, false, 1);
  CHECK_FALSE(rig.channel.full());
  rig.add(0, 1, 1, false, 2);
  CHECK(rig.channel.full());
  rig.channel.advance(15);
  CHECK(rig.channel.full());
  rig.channel.advance(16);
  CHECK_FALSE(rig.channel.full());
}
