// Tests on a mixture of everything on a core that stepping and skipping are equal and every cycle has a
// reason.
// SPDX-License-Identifier: Apache-2.0
#include <string_view>
#include <utility>
#include <vector>

#include "tests/support/catch.h"
#include "tests/timing/core_programs.h"

namespace glint::core {
namespace {

using isa::Special;

// Adds loops over loads, stores, transcendentals, local memory and rays.
void add_mixture(Code& code, Address buffer, Address structure) {
  add_address(code, buffer, 36);
  const int loop = code.here();
  code.add("ld.global.b32", {reg(4), reg(2)});
  code.add("st.local.b32", {reg(0), reg(4)}, 8);
  code.add("sin.f32", {reg(5), reg(4)});
  code.add("ld.const.b32", {reg(9), reg(0)}, 64);
  code.add("ld.local.b32", {reg(6), reg(0)}, 8);
  code.add("add.u32", {reg(1), reg(1), code.constant(1)});
  code.add("add.u32", {reg(6), reg(6), reg(5)});
  code.add("st.global.b32", {reg(2), reg(6)});
  code.add("setp.lt.u32", {1, special(Special::LaneId), reg(1)});
  const int ssy = code.add("ssy");
  const int skip = code.add("bra", {}, 0, 1);
  code.add("div.rn.f32", {reg(7), reg(6), reg(6)});
  code.add("ld.global.b32", {reg(8), reg(2)}, 4096);
  code.set_target(ssy, code.here());
  code.set_target(skip, code.here());
  code.add("join");
  code.add("add.u32", {reg(8), reg(8), reg(7)});
  code.add("setp.lt.u32", {0, reg(1), code.constant(4)});
  code.add("bra", {}, loop, 0);
  add_trace(code, code.constant64(structure));
  code.add("exit");
}

struct Outcome {
  Cycle cycles;
  std::vector<std::pair<std::string_view, uint64_t>> stalls, latency, instructions;
  uint64_t resident, sectors, lanes;
  size_t requests;
  uint64_t slots;
  bool operator==(const Outcome&) const = default;
};

Outcome run_mixture(Params params, OneCore::Options options) {
  mem::AddressSpace space;
  const Address buffer = space.allocate("buffer", 1 << 16), structure = space.allocate("structure", 4096);
  Code code;
  add_mixture(code, buffer, structure);
  options.local_bytes = 64;
  OneCore core(code, params, options);
  core.memory.allocate("buffer", 1 << 16);
  REQUIRE(allocate_structure(core.memory) == structure);
  const Cycle cycles = core.run();
  CHECK_FALSE(core.cell->fault());
  const CoreStats& s = core.stats();
  return {cycles,
          s.stalls.parts(),
          s.latency.parts(),
          s.by_class.parts(),
          s.resident_cycles.value(),
          s.sectors.value(),
          s.lane_instructions.value(),
          core.l1.log().size(),
          s.stalls.total()};
}

}  // namespace

namespace {

// Returns every mechanism that may cost cycles, each as tight as it can be.
Params costly_params() {
  Params params = quick_params();
  params.warps = 16;
  params.block_interval = 3;
  params.write_order = false;
  params.register_file.banks = 2;
  params.fetch = {false, 256, 2, 1};
  params.constant = {false, 64, 1, 32, true};
  params.code_cache = {1024, 2, 12};
  params.lsu.queue = 2;
  params.lsu.accesses = 8;
  params.lsu.war_latency = 11;
  params.lsu.shared_war_latency = 9;
  params.texture = {4, 1, true};
  return params;
}

}  // namespace

TEST_CASE("every cycle of every scheduler has exactly one reason") {
  for (uint32_t warps : {1u, 3u, 40u}) {
    const Outcome outcome = run_mixture(quick_params(), {.num_warps = warps});
    CHECK(outcome.slots == 4 * outcome.cycles);
    const Outcome costly = run_mixture(costly_params(), {.num_warps = warps});
    CHECK(costly.slots == 4 * costly.cycles);
    CHECK(costly.cycles > outcome.cycles);
    CHECK(costly.lanes == outcome.lanes);
  }
}

TEST_CASE("skipping changes nothing where every mechanism costs cycles") {
  for (const std::string& policy : Registry<IssueScheduler>::names())
    for (uint32_t warps : {1u, 5u, 50u}) {
      CAPTURE(policy, warps);
      Params params = costly_params();
      params.issue = PolicyChoice<IssueScheduler>(policy.c_str());
      CHECK(run_mixture(params, {.num_warps = warps, .no_skip = true}) ==
            run_mixture(params, {.num_warps = warps}));
      CHECK(run_mixture(params, {.num_warps = warps, .accesses_per_cycle = 1}) ==
            run_mixture(params, {.num_warps = warps, .no_skip = true, .accesses_per_cycle = 1}));
    }
}

TEST_CASE("skipping cycles in which nothing happens changes nothing") {
  for (const std::string& policy : Registry<IssueScheduler>::names())
    for (uint32_t warps : {1u, 5u, 50u})
      for (size_t rt_capacity : {1u, 4u}) {
        CAPTURE(policy, warps, rt_capacity);
        Params params = quick_params();
        params.issue = PolicyChoice<IssueScheduler>(policy.c_str());
        params.warps = 16;
        params.lsu.queue = 2;
        params.lsu.accesses = 8;
        params.launch_latency = 1000;
        const Outcome stepped =
            run_mixture(params, {.num_warps = warps, .no_skip = true, .rt_capacity = rt_capacity});
        const Outcome skipped =
            run_mixture(params, {.num_warps = warps, .no_skip = false, .rt_capacity = rt_capacity});

        CHECK(stepped == skipped);
      }
}

}  // namespace glint::core
