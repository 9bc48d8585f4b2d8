// Tests times of single ops, crossings between pipes, guards, and words that meet in a bank, to the cycle.
// SPDX-License-Identifier: Apache-2.0
#include "core/op_times.h"

#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>
#include <utility>

#include "isa/op_row.h"
#include "tests/support/catch.h"
#include "tests/unit/core/one_core.h"

namespace glint::core {
namespace {

Params hopper_params() {
  Params params = quick_params();
  params.op_times = PolicyChoice<OpTimes>("hopper");
  params.pipe_crossing = 1;
  params.guard_delay = 9;
  params.units.fp32 = {4, 1};
  return params;
}

// Returns the cycles until the exit behind ten steps could issue, less those behind none.
Cycle chain(const Params& params, const std::function<void(Code&)>& step) {
  Cycle end[2];
  for (int n : {0, 10}) {
    Code code;
    code.add("add.u32", {reg(1), reg(8), reg(9)});
    for (int i = 0; i < n; ++i) step(code);
    code.add("add.u32", {reg(1), reg(1), reg(1)});
    code.add("exit");
    end[n == 10] = OneCore(code, params, {}).run();
  }
  return end[1] - end[0];
}

}  // namespace

TEST_CASE("every entry of a table of op times names an op and has times") {
  for (const std::string& name : Registry<OpTimes>::names()) {
    const auto times = PolicyChoice<OpTimes>(name.c_str()).make({});
    for (const OpTime& time : times->entries()) {
      INFO(name << " " << time.name);
      bool is_first = false;
      for (const isa::OpRow& row : isa::op_table()) is_first |= times->find(row.name) == &time;
      CHECK(is_first);
      CHECK(time.latency >= 1);
      CHECK(time.interval >= 1);
      CHECK(time.interval * OpTime::kParts == std::floor(time.interval * OpTime::kParts));
      CHECK(time.issues >= 1);
      CHECK(time.issues <= time.latency);
    }
  }
}

TEST_CASE("a pattern fits names that have its beginning and its end, without sharing a letter") {
  CHECK(OpTimes::fits("setp.*.f32", "setp.lt.f32"));
  CHECK(OpTimes::fits("vote.*", "vote."));
  CHECK_FALSE(OpTimes::fits("setp.*.f32", "setp.f32"));
  CHECK_FALSE(OpTimes::fits("add.s32", "add.s32x"));
}

TEST_CASE("an op of the table has its own latency, and results reach another pipe a cycle later") {
  const Params params = hopper_params();
  CHECK(chain(params, [](Code& c) { c.add("mul.hi.u32", {reg(1), reg(1), reg(2)}); }) == 10 * 9);
  CHECK(chain(params, [](Code& c) { c.add("add.u32", {reg(1), reg(1), reg(2)}); }) == 10 * 5);
  CHECK(chain(params, [](Code& c) {
          c.add("prmt.b32", {reg(1), reg(1), reg(2), reg(3)});
        }) == 10 * 4 + 1);  // the last add
  CHECK(chain(params, [](Code& c) {
          c.add("and.b32", {reg(1), reg(1), reg(2)});
          c.add("add.u32", {reg(1), reg(1), reg(3)});
        }) == 10 * 10);
}

TEST_CASE(
    "with a latch in front of each pipe an instruction issues to a busy one, and the pipe loses no cycle to "
    "others") {
  // Returns the cycles of two ops of two cycles each, and what a free pipe takes. The third op of the same
  // pipe waits until the second has entered.
  const auto cycles = [](bool latch, const std::vector<const char*>& ops) {
    Params params = hopper_params();
    params.dispatch_latch = latch;
    params.units.integer = {4, 2};
    Code code;
    for (size_t i = 0; i < ops.size(); ++i)
      code.add(ops[i], {reg(uint16_t(1 + i)), reg(20), reg(21), reg(22)});
    code.add("exit");
    return OneCore(code, params, {}).run();
  };
  const auto added = [&](bool latch, const std::vector<const char*>& ops) {
    return cycles(latch, ops) - cycles(latch, {"fma.rn.f32"});
  };
  // They issue at 0, 2, 4, 5 without latches, and at 0, 1, 3, 4 with them.
  CHECK(added(false, {"prmt.b32", "prmt.b32", "prmt.b32", "fma.rn.f32"}) == 5);
  CHECK(added(true, {"prmt.b32", "prmt.b32", "prmt.b32", "fma.rn.f32"}) == 4);
  // They issue at 0, 2, 3, 5 without latches, because the pipe is free at 4 when the other issues at 3. With
  // latches they issue at 0, 1, 2, 3, and the third enters at 4.
  CHECK(added(false, {"prmt.b32", "prmt.b32", "fma.rn.f32", "fma.rn.f32"}) == 4);
  CHECK(added(true, {"prmt.b32", "prmt.b32", "fma.rn.f32", "fma.rn.f32"}) == 3);
  // What waited in front of its pipe is later by as much.
  const auto dependent = [](bool latch) {
    Params params = hopper_params();
    params.dispatch_latch = latch;
    params.units.integer = {4, 2};
    Code code;
    code.add("prmt.b32", {reg(1), reg(20), reg(21), reg(22)});
    code.add("prmt.b32", {reg(2), reg(20), reg(21), reg(22)});
    code.add("prmt.b32", {reg(3), reg(2), reg(21), reg(22)});
    code.add("exit");
    return OneCore(code, params, {}).run();
  };
  CHECK(dependent(true) == dependent(false));
}

TEST_CASE("a predicate guards later than it selects") {
  const Params params = hopper_params();
  CHECK(chain(params, [](Code& c) {
          c.add("setp.lt.u32", {0, reg(1), reg(2)});
          c.add("selp.b32", {reg(1), reg(2), reg(3), 0});
        }) == 10 * 8 + 1);
  CHECK(chain(params, [](Code& c) {
          c.add("setp.lt.u32", {0, reg(1), reg(2)});
          c.add("add.u32", {reg(1), reg(1), reg(3)}, 0, 0);
        }) == 10 * (13 + 5));
}

TEST_CASE(
    "an interval of two cycles and three quarters is kept on average, to the cycle, and is not saved up") {
  const auto products = [](int n) {
    Code code;
    for (int i = 0; i < n; ++i) code.add("mul.wide.u32", {reg(2 * i + 8), reg(0), reg(1)});
    code.add("exit");
    return OneCore(code, hopper_params(), {}).run();
  };
  // The last of n begins at (n - 1) * 2.75, rounded up.
  const Cycle begin[] = {0, 3, 6, 9, 11, 14, 17, 20, 22};
  for (int n = 2; n <= 9; ++n) CHECK(products(n) - products(1) == begin[n - 1]);

  Code late;  // a chain between them: the pipe was idle, so the last two are three cycles apart again
  late.add("mul.wide.u32", {reg(8), reg(0), reg(1)});
  late.add("prmt.b32", {reg(4), reg(0), reg(1), reg(2)});
  late.add("prmt.b32", {reg(5), reg(4), reg(1), reg(2)});
  late.add("mul.wide.u32", {reg(10), reg(5), reg(1)});
  late.add("mul.wide.u32", {reg(12), reg(0), reg(1)});
  late.add("exit");
  CHECK(OneCore(late, hopper_params(), {}).run() - products(1) == 1 + 4 + 5 + 3);
}

TEST_CASE("a sequence takes an issue slot for each of its instructions and ends after the op's latency") {
  CHECK(chain(hopper_params(), [](Code& c) {
          c.add("div.u32", {reg(1), reg(1), reg(2)});
        }) == 10 * 124 + 1);  // the last add

  Code code;
  code.add("div.u32", {reg(1), reg(2), reg(3)});
  code.add("exit");
  OneCore one(code, hopper_params(), {});
  const Cycle end = one.run();
  CHECK(one.stats().instructions.value() == 2);
  CHECK(one.stats().sequence_slots.value() == 16);
  CHECK(one.stats().stalls.count(Stall::Issued) == 18);
  // The exit issues behind the last of them.
  Code empty;
  empty.add("exit");
  CHECK(end - OneCore(empty, hopper_params(), {}).run() == 16 + 1);
}

TEST_CASE("a warp issues nothing before the end of an op with a slow path, and fills the gaps of others") {
  const auto two = [](const char* op) {
    const auto run = [&](int n) {
      Code code;
      for (int i = 0; i < n; ++i) code.add(op, {reg(2 * i + 4), reg(0)});
      code.add("add.u32", {reg(1), reg(2 * n + 2), reg(2 * n + 2)});
      code.add("exit");
      return OneCore(code, hopper_params(), {}).run();
    };
    return run(2) - run(1);
  };
  CHECK(two("rsqrt.approx.f32") == 8);  // the interval of the pipe
  CHECK(two("sqrt.rn.f32") > 40);
}

TEST_CASE("a lane with rare operands makes its warp's division or root longer, as an H100 does") {
  // Returns the cycles until an instruction behind the op can issue, and the issue slots of the op, when the
  // operands are a and b in lanes below `lanes` and 3 and 7 elsewhere. With `leaves_out` these lanes do not
  // execute it.
  const auto run = [](const char* op, float a, float b, uint32_t lanes, bool leaves_out = false) {
    const uint8_t guard = leaves_out ? isa::kGuardNegate : isa::kNoGuard;
    Code code;
    code.add("setp.lt.u32", {0, special(isa::Special::LaneId), code.constant(lanes)});
    const auto operand = [&](int at, float rare, float usual) {
      code.add("selp.b32", {reg(at), code.constant(std::bit_cast<uint32_t>(rare)),
                            code.constant(std::bit_cast<uint32_t>(usual)), 0});
    };
    operand(2, a, 3.0f);
    operand(3, b, 7.0f);
    if (std::string_view(op).starts_with("div"))
      code.add(op, {reg(1), reg(2), reg(3)}, 0, guard);
    else
      code.add(op, {reg(1), reg(2)}, 0, guard);
    code.add("add.u32", {reg(4), reg(1), reg(1)});
    code.add("exit");
    OneCore one(code, hopper_params(), {});
    const Cycle end = one.run();
    return std::pair(end, one.stats().sequence_slots.value());
  };
  const float subnormal = 1e-40f, infinity = std::numeric_limits<float>::infinity();
  const auto added = [&](const char* op, float a, float b, uint32_t lanes) {
    const auto [usual, slots] = run(op, 3, 7, lanes);
    const auto [rare, more] = run(op, a, b, lanes);
    return std::pair(int(rare - usual), int(more - slots));
  };
  // Recorded on an H100: chains of one op, one lane with the operands and 31 with 3 and 7, then all 32.
  CHECK(added("div.rn.f32", 0, 7, 1) == std::pair(321 - 98, 34));
  CHECK(added("div.rn.f32", 0, 7, 32).first == 304 - 98);
  CHECK(added("div.rn.f32", subnormal, 7, 1).first == 577 - 98);
  CHECK(added("div.rn.f32", 3, infinity, 1).first == 321 - 98);
  CHECK(added("div.rn.f32", 1e-37f, 1e-2f, 1).first == 351 - 98);
  CHECK(added("div.rn.f32", 1e-2f, 1e30f, 1).first == 0);
  CHECK(added("sqrt.rn.f32", 0, 0, 1).first == 220 - 97);
  CHECK(added("sqrt.rn.f32", -1, 0, 32).first == 209 - 97);
  CHECK(added("sqrt.rn.f32", 1e30f, 0, 1).first == 0);
  CHECK(added("rcp.rn.f32", 1e38f, 0, 1).first == 379 - 118);
  CHECK(added("rcp.rn.f32", subnormal, 0, 32).first == 260 - 118);
  CHECK(run("div.rn.f32", 0, 7, 1, true) == run("div.rn.f32", 3, 7, 1, true));
  // A double's numerator is two registers.
  Code code;
  code.add("div.rn.f64", {reg(2), code.constant64(0), code.constant64(std::bit_cast<uint64_t>(7.0))});
  code.add("exit");
  OneCore zero(code, hopper_params(), {});
  zero.run();
  CHECK(zero.stats().sequence_slots.value() == 15 + 64);
}

TEST_CASE("lanes that add the constant one to a word of shared memory take one turn where hardware counts") {
  constexpr int kAtomics = 8;
  const auto run = [](bool merges, uint32_t interval, uint32_t addend, bool in_register) {
    Params params = hopper_params();
    params.shared.merges_counts = merges;
    params.shared.atomic_interval = interval;
    Code code;
    code.add("mov.b32", {reg(1), code.constant(0)});
    code.add("mov.b32", {reg(2), code.constant(addend)});
    for (int i = 0; i < kAtomics; ++i)
      code.add("red.shared.add.u32", {reg(1), in_register ? reg(2) : code.constant(addend)});
    code.add("exit");
    return OneCore(code, params, {.block_threads = 32, .shared_bytes = 64}).run();
  };
  const Cycle counting = run(true, 1, 1, false);
  for (const uint32_t interval : {1u, 2u}) {
    // All turns but those that the latency of the last one hides are seen.
    const Cycle turns = run(false, interval, 1, false) - counting, further = kLanes - 1;
    CHECK(turns >= (kAtomics - 1) * further * interval);
    CHECK(turns <= kAtomics * further * interval + 2 * further);
    CHECK(run(true, interval, 1, false) == counting);
    CHECK(run(true, interval, 2, false) == run(false, interval, 1, false));
    CHECK(run(true, interval, 1, true) == run(false, interval, 1, true));
  }
}

TEST_CASE("the slots of a sequence are taken from the other warps of its scheduler") {
  const auto run = [](int warps) {
    Params params = hopper_params();
    params.schedulers = 1;
    Code code;
    code.add("bfi.b32", {reg(1), reg(2), reg(3), reg(4), reg(5)});
    code.add("exit");
    OneCore one(code, params, {.num_warps = uint32_t(warps), .no_skip = warps % 2 == 0});
    one.run();
    return one.stats().stalls.count(Stall::Issued);
  };
  CHECK(run(1) == 5);
  CHECK(run(4) == 20);
}

TEST_CASE("a kernel's own instructions begin behind its prologue, which is longer with shared memory") {
  Code code;
  code.add("exit");
  const auto run = [&](uint32_t instructions, uint32_t shared_instructions, uint32_t shared_bytes) {
    Params params = hopper_params();
    params.prologue = {instructions, shared_instructions};
    return OneCore(code, params, {.block_threads = 32, .shared_bytes = shared_bytes}).run();
  };
  CHECK(run(2, 3, 0) - run(0, 0, 0) == 2);
  CHECK(run(2, 3, 64) - run(0, 0, 64) == 5);
}

TEST_CASE("sequences and prologues end in the same cycle with and without skipping") {
  const auto run = [](bool no_skip) {
    Params params = hopper_params();
    params.prologue = {2, 3};
    Code code;
    for (int i = 0; i < 4; ++i) {
      code.add("div.s32", {reg(1), reg(2), reg(3)});
      code.add("mad.wide.u32", {reg(4), reg(1), reg(3), reg(4)});
    }
    code.add("exit");
    OneCore one(code, params, {.num_warps = 24, .no_skip = no_skip});
    const Cycle end = one.run();
    return std::pair(end, one.stats().stalls.count(Stall::RawSfu));
  };
  CHECK(run(true) == run(false));
}

}  // namespace glint::core
