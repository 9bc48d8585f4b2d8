// Tests to whom a core's cycles are charged, and what a core says that waits forever.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <utility>

#include "base/diagnostics.h"
#include "tests/support/catch.h"
#include "tests/unit/core/one_core.h"

namespace glint::core {
namespace {

uint64_t slots(const OneCore& core, uint32_t pc, Stall reason) {
  return core.cell->profile()->of(pc).slots[size_t(reason)];
}

}  // namespace

TEST_CASE("a wait is charged to the instruction that waits, an issue to the one issued") {
  Code code;
  code.add("sin.f32", {reg(1), reg(1)});
  code.add("add.u32", {reg(2), reg(1), reg(1)});
  code.add("exit");
  OneCore core(code, quick_params(), {});
  core.profile = true;
  core.run();

  CHECK(slots(core, 0, Stall::Issued) == 1);
  CHECK(slots(core, 1, Stall::RawSfu) == 20);
  CHECK(slots(core, 1, Stall::Issued) == 1);
  CHECK(slots(core, 2, Stall::Issued) == 1);
  CHECK(core.cell->profile()->of(0).lanes == 32);
  // The other three schedulers have no warp, for 23 cycles each.
  CHECK(core.cell->profile()->nowhere().slots[size_t(Stall::NoWarp)] == 3 * 23);
}

TEST_CASE("of several warps that wait for the same, the one that goes on first is charged") {
  // Warps 0 and 4 belong to one scheduler. The younger is an instruction behind, so the wait belongs to the
  // older one.
  Code code;
  code.add("sin.f32", {reg(1), reg(1)});
  code.add("sin.f32", {reg(2), reg(1)});
  code.add("exit");
  Params params = quick_params();
  params.schedulers = 1;
  OneCore core(code, params, {.num_warps = 2});
  core.profile = true;
  core.run();

  uint64_t sum = 0;
  for (uint32_t pc = 0; pc < 3; ++pc)
    for (size_t i = 0; i < size_t(Stall::Count); ++i) sum += core.cell->profile()->of(pc).slots[i];
  CHECK(sum == core.stats().cycles.value());
  CHECK(core.cell->profile()->of(0).issues == 2);
  CHECK(slots(core, 0, Stall::MathThrottle) == 7);  // the second warp's turn on the pipe
  CHECK(slots(core, 1, Stall::RawSfu) == core.stats().stalls.count(Stall::RawSfu));
}

TEST_CASE("profiles of stepping and skipping are the same, and so are those of any window") {
  const auto profile = [](bool no_skip, Cycle window) {
    Code code;
    for (int i = 0; i < 6; ++i) {
      code.add("sin.f32", {reg(i + 1), reg(i)});
      code.add("fma.rn.f32", {reg(8), reg(i + 1), reg(8), reg(8)});
      code.add("add.u32", {reg(9), reg(8), reg(9)});
    }
    code.add("exit");
    OneCore core(code, quick_params(), {.num_warps = 13, .no_skip = no_skip, .window = window});
    core.profile = true;
    core.run();
    std::vector<uint64_t> out;
    for (uint32_t pc = 0; pc < 19; ++pc)
      for (size_t i = 0; i < size_t(Stall::Count); ++i) out.push_back(slots(core, pc, Stall(i)));
    return out;
  };

  CHECK(profile(false, 32) == profile(true, 32));
  CHECK(profile(false, 32) == profile(false, 7));
}

TEST_CASE("a profile changes no cycle and no statistic") {
  const auto run = [](bool profiled) {
    Code code;
    for (int i = 0; i < 20; ++i)
      code.add(i % 3 ? "fma.rn.f32" : "sin.f32", {reg(i % 5 + 1), reg(i % 4), reg(0), reg(0)});
    code.add("exit");
    OneCore core(code, quick_params(), {.num_warps = 9});
    core.profile = profiled;
    const Cycle end = core.run();
    return std::pair(end, core.stats().stalls.count(Stall::RawSfu));
  };

  CHECK(run(true) == run(false));
}

TEST_CASE("a core whose memory never answers is stuck, and says which warp waits for what") {
  Code code;
  code.add("mad.wide.u32", {reg(2), special(isa::Special::LaneId), code.constant(4), code.constant64(0)});
  const int load = code.add("ld.global.b32", {reg(1), reg(2)});
  code.add("add.u32", {reg(4), reg(1), reg(1)});
  code.add("exit");
  mem::AddressSpace probe;
  // The first allocation lies at the same place in every space.
  const Address at = probe.allocate("buffer", 4096);
  code.program().constants[1] = uint32_t(at);
  code.program().constants[2] = uint32_t(at >> 32);
  OneCore core(code, quick_params(), {});
  REQUIRE(core.memory.allocate("buffer", 4096) == at);
  core.l1.swallow();

  try {
    core.run();
    FAIL("the core came to an end");
  } catch (const Error& error) {
    const std::string text = error.what();
    CHECK(error.exit() == Exit::Stuck);
    CHECK(int(error.exit()) == 5);
    CHECK(text.find("long_scoreboard without a known end, 1 accesses in flight") != std::string::npos);
    CHECK(text.find("memory: 1 reads never answered") != std::string::npos);
  }
  CHECK(load == 1);
}

}  // namespace glint::core
