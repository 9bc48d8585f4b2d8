// Tests a core whose instructions and constants first have to come, to the cycle.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "tests/support/catch.h"
#include "tests/timing/core_programs.h"

namespace glint::core {
namespace {

// Returns parameters in which misses take 10 cycles to the cache behind and back, and 20 of memory.
Params params_with_fetch(uint32_t prefetch) {
  Params params = quick_params();
  params.fetch = {false, 16384, 32, prefetch};
  params.code_cache.latency = 10;
  params.units.integer.interval = 1;
  return params;
}

Params params_with_constants() {
  Params params = quick_params();
  params.constant.perfect = false;
  params.code_cache.latency = 10;
  return params;
}

// Adds `n` additions that do not wait for each other, and an exit.
void add_line(Code& code, int n) {
  for (int i = 0; i < n; ++i) code.add("add.u32", {reg(i + 1), reg(0), reg(0)});
  code.add("exit");
}

}  // namespace

TEST_CASE("a warp waits for each line of instructions that nobody has fetched") {
  for (const int n : {7, 8}) {
    CAPTURE(n);
    Code code;
    add_line(code, n);
    OneCore core(code, params_with_fetch(0), {});

    // The second line is asked for when the eighth instruction has issued.
    CHECK(core.run() == (n == 7 ? 30u + 8 : 30u + 7 + 30 + 1));
    CHECK(stall(core, Stall::NoInstruction) == (n == 7 ? 30 : 30 + 29));
    CHECK(core.stats().instructions.value() == uint64_t(n) + 1);
  }
}

TEST_CASE("the stream buffer has the second line when the warp comes to it") {
  Code code;
  add_line(code, 8);
  OneCore core(code, params_with_fetch(1), {});

  CHECK(core.run() == 30 + 9);
}

TEST_CASE("instructions lie where the core is told, and whole lines are read") {
  Code code;
  add_line(code, 8);
  OneCore core(code, params_with_fetch(0), {.code = 1 << 16});
  core.run();

  REQUIRE(core.l1.log().size() == 2);
  CHECK(core.l1.log()[1].line == (1 << 16) + 128);
  CHECK(core.l1.log()[1].sectors == 0xf);
}

TEST_CASE("a loop comes to its lines again at no cost") {
  Code code;
  code.add("mov.b32", {reg(1), code.constant(0)});
  const int loop = code.here();
  for (int i = 0; i < 10; ++i) code.add("add.u32", {reg(2 + i), reg(0), reg(0)});
  code.add("add.u32", {reg(1), reg(1), code.constant(1)});
  code.add("setp.lt.u32", {0, reg(1), code.constant(100)});
  code.add("bra", {}, loop, 0);
  code.add("exit");
  const auto run = [&](bool perfect) {
    Params params = params_with_fetch(0);
    params.fetch.perfect = perfect;
    OneCore core(code, params, {});
    return core.run();
  };

  CHECK(run(false) == run(true) + 30 + 29);  // two lines, the second from the issue before on
}

TEST_CASE("warps of all schedulers share the cache behind their own") {
  Code code;
  add_line(code, 3);
  OneCore core(code, params_with_fetch(0), {.num_warps = 8});
  const Cycle cycles = core.run();

  CHECK(core.l1.log().size() == 1);
  CHECK(cycles == 30 + 2 * 4);  // A line on its way comes to all four at once; two warps per scheduler.
}

TEST_CASE("a constant that is not there comes with its line, and then takes its time") {
  Code code;
  code.add("ld.const.b32", {reg(1), reg(0)}, 64);  // 0; the line in 30
  code.add("ld.const.b32", {reg(2), reg(0)}, 68);  // 30, a hit
  code.add("add.u32", {reg(3), reg(2), reg(2)});   // 56
  code.add("exit");
  OneCore core(code, params_with_constants(), {});

  CHECK(core.run() == 30 + 26 + 2);
  CHECK(stall(core, Stall::Const) == 29 + 25);
  CHECK(core.l1.log().size() == 1);
  CHECK(core.l1.log()[0].traffic == mem::Traffic::Constant);
}

TEST_CASE("what depends on a constant that misses waits for its time after the line") {
  Code code;
  code.add("ld.const.b32", {reg(1), reg(0)}, 64);
  code.add("add.u32", {reg(3), reg(1), reg(1)});
  code.add("exit");
  OneCore core(code, params_with_constants(), {});

  CHECK(core.run() == 30 + 26 + 2);
}

TEST_CASE("a constant load takes a turn for each different address") {
  for (const uint32_t words : {1u, 2u, 32u}) {
    CAPTURE(words);
    Code code;
    code.add("rem.u32", {reg(1), special(isa::Special::LaneId), code.constant(words)});
    code.add("mul.lo.u32", {reg(1), reg(1), code.constant(4)});
    code.add("ld.const.b32", {reg(2), reg(1)});
    code.add("ld.const.b32", {reg(4), reg(1)}, 256);
    code.add("add.u32", {reg(3), reg(2), reg(2)});
    code.add("exit");
    Params params = quick_params();
    params.constant.serial = true;
    params.units.integer = params.units.int_div = {4, 1};
    params.units.constant = {26, 2};
    OneCore core(code, params, {});

    // The line comes in 8, and the result in 26 and two for each address but one.
    CHECK(core.run() == 8 + 26 + 2 * (words - 1) + 2);
    CHECK(stall(core, Stall::MathThrottle) == 2 * words - 1);
  }
}

TEST_CASE("turns of a constant load may be further apart, and later still in its result") {
  Code code;
  code.add("ld.const.b8", {reg(2), special(isa::Special::LaneId)});
  code.add("ld.const.b8", {reg(4), special(isa::Special::LaneId)}, 256);
  code.add("add.u32", {reg(3), reg(2), reg(2)});
  code.add("exit");
  Params params = quick_params();
  params.constant.serial = true;
  params.constant.place_interval = 8;
  params.constant.place_latency = 11;
  params.units.constant = {26, 2};
  OneCore core(code, params, {});

  CHECK(core.run() == 26 + 11 * 31 + 2);
  CHECK(stall(core, Stall::MathThrottle) == 2 + 8 * 31 - 1);
}

}  // namespace glint::core
