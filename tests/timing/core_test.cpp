// Tests to the cycle when a core issues: latencies, intervals, hazards and stalls.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <vector>

#include "tests/support/catch.h"
#include "tests/timing/core_programs.h"

namespace glint::core {
namespace {

using isa::Special;

}  // namespace

TEST_CASE("a dependent chain issues once a latency") {
  for (uint32_t n : {1u, 2u, 10u}) {
    Code code;
    for (uint32_t i = 0; i < n; ++i) code.add("add.u32", {reg(1), reg(1), reg(1)});
    code.add("exit");
    OneCore core(code, quick_params(), {});

    CHECK(core.run() == (n - 1) * 4 + 2);  // exit a cycle after the last add
    CHECK(stall(core, Stall::RawFixed) == (n - 1) * 3);
    CHECK(stall(core, Stall::Issued) == n + 1);
  }
}

TEST_CASE("independent instructions issue at the pipe's interval") {
  Code code;
  for (int i = 0; i < 10; ++i) code.add("add.u32", {reg(i + 1), reg(0), reg(0)});
  code.add("exit");
  OneCore core(code, quick_params(), {});

  CHECK(core.run() == 9 * 2 + 2);
  CHECK(stall(core, Stall::MathThrottle) == 9);
}

TEST_CASE("instructions on different pipes issue back to back") {
  Code code;
  for (int i = 0; i < 5; ++i) {
    code.add("add.u32", {reg(2 * i + 1), reg(0), reg(0)});
    code.add("fma.rn.f32", {reg(2 * i + 2), reg(0), reg(0), reg(0)});
  }
  code.add("exit");
  OneCore core(code, quick_params(), {});

  CHECK(core.run() == 11);
}

TEST_CASE("a long latency is charged under its own reason") {
  Code code;
  code.add("sin.f32", {reg(1), reg(1)});
  code.add("add.u32", {reg(2), reg(1), reg(1)});
  code.add("exit");
  OneCore core(code, quick_params(), {});

  CHECK(core.run() == 21 + 2);
  CHECK(stall(core, Stall::RawSfu) == 20);
}

TEST_CASE("warps of one scheduler share its pipes, warps of different schedulers do not") {
  const auto run = [](uint32_t num_warps) {
    Code code;
    for (int i = 0; i < 10; ++i) code.add("add.u32", {reg(i + 1), reg(0), reg(0)});
    code.add("exit");
    OneCore core(code, quick_params(), {.num_warps = num_warps});
    return core.run();
  };

  CHECK(run(4) == 20);
  CHECK(run(5) == 40);  // slots 0 and 4: the second starts when the first has ended, greedily
}

TEST_CASE("a load is ready for use after the unit's and the memory's latency") {
  mem::AddressSpace space;
  // The first allocation's address is the same in every space.
  const Address base = space.allocate("buffer", 4096);
  Code code;
  add_address(code, base, 4);
  code.add("ld.global.b32", {reg(4), reg(2)});
  code.add("add.u32", {reg(5), reg(4), reg(4)});
  code.add("exit");
  OneCore core(code, quick_params(), {});
  REQUIRE(core.memory.allocate("buffer", 4096) == base);

  CHECK(core.run() == 4 + 12 + 20 + 2);
  CHECK(stall(core, Stall::LongScoreboard) == 31);
  CHECK(core.stats().sectors.value() == 4);
  CHECK(core.stats().lines.value() == 1);
  CHECK(core.stats().latency.count(isa::Class::Mem) == 32);
}

TEST_CASE("a scattered load waits for its last line") {
  mem::AddressSpace space;
  const Address base = space.allocate("buffer", 1 << 16);
  Code code;
  add_address(code, base, 128);
  code.add("ld.global.b32", {reg(4), reg(2)});
  code.add("add.u32", {reg(5), reg(4), reg(4)});
  code.add("exit");
  OneCore core(code, quick_params(), {});
  REQUIRE(core.memory.allocate("buffer", 1 << 16) == base);

  CHECK(core.run() == 4 + 12 + 31 + 20 + 2);
  CHECK(core.stats().lines.value() == 32);
  CHECK(core.stats().sectors.value() == 32);
}

TEST_CASE("a register that a load will write is not overwritten before") {
  mem::AddressSpace space;
  const Address base = space.allocate("buffer", 4096);
  Code code;
  add_address(code, base, 4);
  code.add("ld.global.b32", {reg(4), reg(2)});
  code.add("mov.b32", {reg(4), code.constant(7)});
  code.add("exit");
  OneCore core(code, quick_params(), {});
  REQUIRE(core.memory.allocate("buffer", 4096) == base);

  CHECK(core.run() == 4 + 12 + 20 + 2);
}

TEST_CASE(
    "a register that a load has read may be overwritten at once, and a warp drains before its slot is free") {
  mem::AddressSpace space;
  const Address base = space.allocate("buffer", 4096);
  Code code;
  add_address(code, base, 4);
  code.add("ld.global.b32", {reg(4), reg(2)});      // 4
  code.add("mov.b32", {reg(2), code.constant(7)});  // 5
  code.add("exit");                                 // 6
  OneCore core(code, quick_params(), {});
  REQUIRE(core.memory.allocate("buffer", 4096) == base);

  CHECK(core.run() == 37);                 // the load comes back in cycle 36
  CHECK(stall(core, Stall::Drain) == 29);  // 7 to 35
}

TEST_CASE("a warp does not issue before its branch is resolved") {
  Code code;
  code.add("bra", {}, 1);
  code.add("exit");
  OneCore core(code, quick_params(), {});

  CHECK(core.run() == 5);
  CHECK(stall(core, Stall::Branch) == 3);
}

TEST_CASE("a branch that splits its warp is counted, a uniform one is not") {
  for (uint32_t limit : {16u, 32u}) {
    Code code;
    code.add("setp.lt.u32", {0, special(Special::LaneId), code.constant(limit)});
    const int ssy = code.add("ssy");
    const int bra = code.add("bra", {}, 0, 0);
    code.add("add.u32", {reg(1), reg(1), reg(1)});
    const int join = code.add("join");
    code.add("exit");
    code.set_target(ssy, join);
    code.set_target(bra, join);
    OneCore core(code, quick_params(), {});
    core.run();

    CHECK(core.stats().branches.value() == 1);
    CHECK(core.stats().divergent_branches.value() == (limit == 16));
    // A branch counts the lanes that take it; only the lanes that fell through run the join themselves.
    CHECK(core.stats().lane_instructions.value() == (limit == 16 ? 32u + 32 + 16 + 16 + 16 + 32 : 5 * 32u));
  }
}

TEST_CASE("local memory has its own addresses and reason") {
  Code code;
  code.add("ld.local.v4.b32", {reg(4), reg(5), reg(6), reg(7), reg(0)}, 16);
  code.add("add.u32", {reg(8), reg(7), reg(7)});
  code.add("exit");
  OneCore core(code, quick_params(), {.local_bytes = 256});

  CHECK(core.run() == 12 + 3 * 2 + 20 + 2);  // four whole lines, two cycles each
  REQUIRE(core.l1.log().size() == 4);
  CHECK(core.l1.log()[0].line == OneCore::kLocalBase + 4 * 128);
  CHECK(core.l1.log()[0].traffic == mem::Traffic::ShaderLocal);
  CHECK(stall(core, Stall::LocalMemory) == 37);
  CHECK(core.stats().local_loads.value() == 1);
}

TEST_CASE("with memory of its own, each lane of a warp makes an access to a line of its own") {
  Code code;
  code.add("ld.local.v4.b32", {reg(4), reg(5), reg(6), reg(7), reg(0)}, 16);
  code.add("exit");
  Params params = quick_params();
  params.local_by_thread = true;
  OneCore core(code, params, {.local_bytes = 256});
  core.run();

  REQUIRE(core.l1.log().size() == 32);
  for (size_t lane = 0; lane < 32; ++lane)  // 256 bytes of stack, and as many for the attributes
    CHECK(core.l1.log()[lane].line == OneCore::kLocalBase + lane * 512);
}

TEST_CASE("a traced warp sleeps until the RT unit gives it back") {
  mem::AddressSpace space;
  const Address structure = allocate_structure(space);
  Code code;
  add_trace(code, code.constant64(structure));
  code.add("exit");
  OneCore core(code, quick_params(), {});
  REQUIRE(allocate_structure(core.memory) == structure);

  CHECK(core.run() == OneCore::kRayLatency + 4 + 1);
  CHECK(core.rays.lanes() == std::vector<LaneMask>{kAllLanes});
  CHECK(stall(core, Stall::RtWait) == 103);
  CHECK(core.stats().rt_lanes.value() == 32);
}

TEST_CASE("rays that have nowhere to go do not visit the RT unit") {
  Code code;
  add_trace(code, code.constant64(0));
  code.add("exit");
  OneCore core(code, quick_params(), {});

  CHECK(core.run() == 5);
  CHECK(core.rays.lanes().empty());
}

TEST_CASE("a full RT unit holds back the next warp") {
  mem::AddressSpace space;
  const Address structure = allocate_structure(space);
  Code code;
  add_trace(code, code.constant64(structure));
  code.add("exit");
  OneCore core(code, quick_params(), {.num_warps = 2, .rt_capacity = 1});
  REQUIRE(allocate_structure(core.memory) == structure);

  CHECK(core.run() == 2 * OneCore::kRayLatency + 4 + 1);
  CHECK(stall(core, Stall::RtFull) == 100);
}

TEST_CASE("the launch latency passes before the first instruction") {
  Code code;
  code.add("exit");
  Params params = quick_params();
  params.launch_latency = 100;
  params.warp_launch_latency = 7;
  OneCore core(code, params, {});

  CHECK(core.run() == 108);
  CHECK(stall(core, Stall::Dispatch) == 107);
  CHECK(stall(core, Stall::NoWarp) == 3 * 108);
}

TEST_CASE("warps beyond the occupancy wait for a slot") {
  Code code;
  for (int i = 0; i < 100; ++i) code.add("add.u32", {reg(1), reg(1), reg(1)});
  code.add("exit");
  Params params = quick_params();
  params.warps = 2;
  OneCore core(code, params, {.num_warps = 5});
  const Cycle cycles = core.run();

  CHECK(core.stats().warps.value() == 5);
  CHECK(core.stats().slot_cycles.value() == 2 * cycles);
  // There are three rounds of 398 cycles, each begun at the start of a window of 32.
  CHECK(cycles == 2 * 416 + 398);
  // A slot is free after its warp's last cycle.
  CHECK(core.stats().resident_cycles.value() == 5 * 397);
}

TEST_CASE("an endless warp ends with a fault that names the place") {
  Code code;
  code.add("bra", {}, 0);
  Params params = quick_params();
  params.instruction_budget = 1000;
  OneCore core(code, params, {.num_warps = 3});
  core.run();

  REQUIRE(core.cell->fault());
  CHECK(core.cell->fault()->what ==
        "no end in sight: the warp has executed more than 1000 instructions, and --max-instructions allows "
        "more; "
        "the warp is in the loop of instruction 0");
  CHECK(core.cell->fault()->place.find("bra") != std::string::npos);
  CHECK(core.cell->fault()->launch_id == std::array<uint32_t, 3>{0, 0, 0});
}

TEST_CASE("an access outside memory stops the core with the executor's fault") {
  Code code;
  add_address(code, 64, 4);
  code.add("ld.global.b32", {reg(4), reg(2)});
  code.add("exit");
  OneCore core(code, quick_params(), {});
  core.run();

  REQUIRE(core.cell->fault());
  CHECK(core.cell->fault()->what.find("reads 4 bytes") != std::string::npos);
}

}  // namespace glint::core
