// Times of single ops, crossings between pipes, guards, and words that meet in a bank of the L1: to the cycle.
// SPDX-License-Identifier: Apache-2.0
#include "core/op_times.h"

#include <functional>

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

// Cycles until the exit behind ten steps could issue, less those behind none.
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
  CHECK(chain(params, [](Code& c) { c.add("prmt.b32", {reg(1), reg(1), reg(2), reg(3)}); }) == 10 * 4 + 1);  // the last add
  CHECK(chain(params, [](Code& c) {
          c.add("and.b32", {reg(1), reg(1), reg(2)});
          c.add("add.u32", {reg(1), reg(1), reg(3)});
        }) == 10 * 10);
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

}  // namespace glint::core
