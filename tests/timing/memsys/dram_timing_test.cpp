// DRAM commands to the clock: row hits, misses, conflicts, windows and turnarounds.
// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "memsys/dram_channel.h"
#include "tests/support/catch.h"

using namespace glint;
using namespace glint::mem;

namespace {

// Core and command clocks are equal, all times are whole clocks, and an access moves 4 clocks of data.
DramParams plain() {
  DramParams p;
  p.clock_mhz = 1000.0;
  p.refresh = "none";
  p.rcd = 15, p.rcd_write = 9, p.rp = 16, p.ras = 30, p.rc = 46, p.cl = 14, p.wl = 4, p.wr = 17, p.rtp = 5;
  p.ccd_s = 4, p.ccd_l = 6, p.rrd_s = 5, p.rrd_l = 7, p.faw = 40, p.wtr_s = 8, p.wtr_l = 10;
  return p;
}

// One channel; addresses are chosen by bank group, bank in the group and row, with the mapping turned back.
class Rig {
 public:
  explicit Rig(const DramParams& params) : root(nullptr, "test"), params_(params), channel({params_, 256, 1000.0, &root}) {
    DramMap map(params.banks, params.bank_groups, params.row_bytes, 256);
    for (Address local = 0; local < Address{params.banks} * params.row_bytes * 8; local += 256) {
      const DramLocation at = map.locate(local);
      place_.try_emplace({at.bank, at.row}, local);
    }
  }
  void add(Cycle now, uint32_t bank, uint32_t row, bool write = false, uint32_t name = 0) {
    channel.advance(now);
    channel.add(now, name * 128, 1, place_.at({bank, row}), write);
  }
  // Runs to the end; the cycle at which each read's data was complete, by name.
  std::map<uint32_t, Cycle> run() {
    std::map<uint32_t, Cycle> out;
    while (channel.next_command() != kNever) channel.advance(channel.next_command());
    for (; !channel.returns().empty(); channel.returns().pop())
      out[uint32_t(channel.returns().front().line / 128)] = channel.returns().front().ready;
    return out;
  }
  Cycle read_alone(uint32_t bank, uint32_t row) {
    const Cycle start = idle_;
    add(start, bank, row);
    const Cycle end = run()[0];
    idle_ = end + 1000;
    return end - start;
  }

  stats::Group root;

 private:
  DramParams params_;

 public:
  DramChannel channel;

 private:
  std::map<std::pair<uint32_t, uint32_t>, Address> place_;
  Cycle idle_ = 0;
};

constexpr Cycle kEdge = 1;  // a request is seen at the next clock edge
constexpr Cycle kData = 4;

}  // namespace

TEST_CASE("a closed bank needs activate and read, an open row only read, a conflict precharge too") {
  Rig rig(plain());
  CHECK(rig.read_alone(3, 1) == kEdge + 15 + 14 + kData);
  CHECK(rig.read_alone(3, 1) == kEdge + 14 + kData);
  CHECK(rig.read_alone(3, 2) == kEdge + 16 + 15 + 14 + kData);
  CHECK(rig.channel.stats().activates.value() == 2);
  CHECK(rig.channel.stats().precharges.value() == 1);
  CHECK(rig.channel.stats().row_hits.value() == 1);
}

TEST_CASE("row hits of one bank group are spaced by the long column delay, of two by the short one") {
  for (const auto& [second, spacing] : {std::pair{0u, 6}, {4u, 6}, {1u, 4}}) {
    Rig rig(plain());
    rig.read_alone(0, 1), rig.read_alone(second, 1);
    rig.add(9000, 0, 1, false, 1);
    rig.add(9000, second, 1, false, 2);
    auto at = rig.run();
    CHECK(at[2] - at[1] == Cycle(spacing));
  }
}

TEST_CASE("a bank that was just opened is not closed before tRAS") {
  Rig rig(plain());
  rig.add(0, 0, 1, false, 1);
  rig.add(0, 0, 2, false, 2);
  auto at = rig.run();
  CHECK(at[1] == kEdge + 15 + 14 + kData);
  // Precharge at 1 + 30, activate 16 later: tRC = 46 agrees.
  CHECK(at[2] == kEdge + 30 + 16 + 15 + 14 + kData);
}

TEST_CASE("a long tRC holds back the next activate of the bank") {
  DramParams params = plain();
  params.rc = 60;
  Rig rig(params);
  rig.add(0, 0, 1, false, 1);
  rig.add(0, 0, 2, false, 2);
  CHECK(rig.run()[2] == kEdge + 60 + 15 + 14 + kData);
}

TEST_CASE("activates are spaced by tRRD and the fifth waits for the window of four") {
  DramParams params = plain();
  params.dual_command_bus = true;
  Rig rig(params);
  for (uint32_t i = 0; i < 5; ++i) rig.add(0, i, 1, false, i + 1);  // banks 0 to 3 in groups 0 to 3, bank 4 in group 0
  auto at = rig.run();
  const Cycle first = kEdge + 15 + 14 + kData;
  CHECK(at[1] == first);
  CHECK(at[2] == first + 5);
  CHECK(at[3] == first + 10);
  CHECK(at[4] == first + 15);
  CHECK(at[5] == first + 40);
}

TEST_CASE("on a single command bus an activate gives way to a column command of the same clock") {
  Rig rig(plain());
  for (uint32_t i = 0; i < 4; ++i) rig.add(0, i, 1, false, i + 1);
  // The fourth activate would go out at clock 16, as the first read does.
  CHECK(rig.run()[4] == kEdge + 15 + 1 + 15 + 14 + kData);
}

TEST_CASE("two activates of one bank group are spaced by the long tRRD") {
  Rig rig(plain());
  rig.add(0, 0, 1, false, 1);
  rig.add(0, 4, 1, false, 2);
  auto at = rig.run();
  CHECK(at[2] - at[1] == 7);
}

TEST_CASE("a read after a write waits for the data and tWTR of its bank group") {
  for (const auto& [second, wtr] : {std::pair{0u, 10u}, {1u, 8u}}) {
    Rig rig(plain());
    rig.read_alone(0, 1), rig.read_alone(second, 1);
    rig.add(9000, 0, 1, true);
    rig.add(9000, second, 1, false, 2);
    CHECK(rig.run()[2] == 9000 + kEdge + 4 + kData + wtr + 14 + kData);
    CHECK(rig.channel.stats().turnarounds.value() == 2);
  }
}

TEST_CASE("a write after a read waits until the bus can turn") {
  Rig rig(plain());
  rig.read_alone(0, 1), rig.read_alone(1, 1);
  rig.add(9000, 0, 1, false, 1);
  rig.add(9000, 1, 1, true);
  rig.add(9000, 2, 1, false, 3);  // ends after the write: activate, and tWTR after the write
  auto at = rig.run();
  const Cycle write_at = 9000 + kEdge + 14 + kData + 2 - 4;
  CHECK(at[3] == write_at + 4 + kData + 8 + 14 + kData);
}

TEST_CASE("a written row is not closed before its write recovery") {
  Rig rig(plain());
  rig.read_alone(0, 1);
  rig.add(9000, 0, 1, true);
  rig.add(9000, 0, 2, false, 2);
  CHECK(rig.run()[2] == 9000 + kEdge + 4 + kData + 17 + 16 + 15 + 14 + kData);
}

TEST_CASE("FR-FCFS serves a younger row hit first and FCFS does not") {
  const auto order = [](const char* scheduler) {
    DramParams params = plain();
    params.scheduler = PolicyChoice<DramScheduler>(scheduler);
    Rig rig(params);
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
  Rig rig(plain());
  for (uint32_t bank = 0; bank < 4; ++bank) rig.read_alone(bank, 1);
  const uint64_t busy = rig.channel.stats().busy_clocks.value();
  for (uint32_t i = 0; i < 64; ++i) rig.add(9000, i % 4, 1, false, i + 1);
  auto at = rig.run();
  CHECK(at[64] - at[1] == 63 * kData);
  CHECK(rig.channel.stats().busy_clocks.value() - busy == 64 * kData);
}

TEST_CASE("every command clock is attributed and the ratios follow their definitions") {
  Rig rig(plain());
  rig.add(0, 0, 1, false, 1);
  rig.add(0, 1, 1, false, 2);
  rig.run();
  rig.channel.finish(1000);
  const DramStats& s = rig.channel.stats();
  CHECK(s.clocks.value() == 1000);
  CHECK(s.use.total() == 1000);
  CHECK(s.use.count(DramUse::Data) == 2 * kData);
  CHECK(s.utilisation.value() == Approx(0.008));
  // Clock 1: both banks take a request. 16 and 21: their reads. Bank 0's row may run its tRC to clock 47, bank 1's to 52.
  CHECK(s.any_bank_clocks.value() == 20);
  CHECK(s.bank_clocks.value() == 15 + 20);
  CHECK(s.active_clocks.value() == 51);
  CHECK(s.efficiency.value() == Approx(8.0 / 51.0));
  // Clocks 1 to 15 wait for tRCD, clock 20 for the second read; the data of both start with their commands.
  CHECK(s.use.count(DramUse::ColumnWait) == 15 + 1);
  CHECK(s.use.count(DramUse::RowWait) == 0);
  CHECK(s.use.count(DramUse::Idle) == 1000 - 8 - 16);
  rig.add(2000, 0, 2, false, 3);
  rig.run();
  CHECK(s.use.count(DramUse::RowWait) == 16);  // precharge to activate
}

TEST_CASE("a full queue says so and frees a place with each column command") {
  DramParams params = plain();
  params.queue = 2;
  Rig rig(params);
  rig.add(0, 0, 1, false, 1);
  CHECK_FALSE(rig.channel.full());
  rig.add(0, 1, 1, false, 2);
  CHECK(rig.channel.full());
  rig.channel.advance(15);
  CHECK(rig.channel.full());
  rig.channel.advance(16);
  CHECK_FALSE(rig.channel.full());
}
