// Tests limits of a core that show in one cycle only: room for blocks, exits at barriers, records of calls,
// banks.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/timing_machine.h"
#include "tests/support/catch.h"
#include "tests/support/small_jobs.h"
#include "tests/timing/core_programs.h"
#include "tests/unit/core/one_core.h"
#include "tests/unit/exec/text_launch.h"

namespace glint::core {
namespace {

// Returns the cycles of one warp that loads twice from global memory at a stride and uses both values.
Cycle two_loads(const Params& params, uint32_t stride) {
  mem::AddressSpace space;
  // The first allocation's address is the same in every space.
  const Address base = space.allocate("buffer", 1 << 16);
  Code code;
  code.add("mad.wide.u32",
           {reg(2), special(isa::Special::LaneId), code.constant(stride), code.constant64(base)});
  code.add("ld.global.b32", {reg(4), reg(2)});
  code.add("ld.global.b32", {reg(6), reg(2)}, 4096);
  code.add("add.u32", {reg(5), reg(4), reg(6)});
  code.add("exit");
  OneCore core(code, params, {});
  REQUIRE(core.memory.allocate("buffer", 1 << 16) == base);
  return core.run();
}

// Returns the cycles of one warp whose lanes call the callable shaders of `num_called` records of 32 B. All
// return at once.
Cycle call_of_callables(const Params& params, uint32_t num_called, Cycle& waited) {
  Code caller;
  caller.add("min.u32", {reg(4), special(isa::Special::LaneId), caller.constant(num_called - 1)});
  caller.add("call.sbt.callable", {reg(4), special(isa::Special::Payload)});
  caller.add("exit");
  Code callee;
  callee.add("ret");
  callee.program().stage = isa::Stage::Callable;
  OneCore core(caller, params, {});
  core.image = exec::link({caller.program(), callee.program()});
  core.world.callable.assign(num_called, 1);
  core.world.table.callable.base = core.memory.allocate("records", num_called * exec::kHandleBytes);
  const Cycle end = core.run();
  CHECK(core.stats().binding_reads.value() == 1);
  waited = stall(core, Stall::Call);
  return end;
}

// Returns the cycles of a launch of one block of one warp on a machine of `cores` cores.
Cycle machine_cycles(const std::string& text, uint32_t cores) {
  exec::TextLaunch launch(text, {});
  pipeline::GpuParams params = test::preset("mobile");
  params.cores = cores;
  params.core.launch_latency = 0;
  params.core.fence.gpu = 1;
  return pipeline::TimingMachine(params, launch.world, false).run({});
}

}  // namespace

TEST_CASE("blocks fit into shared memory to the last byte, and not into one less") {
  const auto most_resident = [](uint32_t shared_bytes) {
    Code code;
    code.add("exit");
    Params params = quick_params();
    params.shared_bytes = shared_bytes;
    OneCore core(code, params, {.num_warps = 4, .block_threads = 32, .shared_bytes = 1000});
    return core.run() <= 2 ? 4 : 1;  // the first window takes all of them or not
  };
  CHECK(most_resident(4000) == 4);
  CHECK(most_resident(3999) == 1);
}

TEST_CASE("an access of no lane takes an issue slot and nothing else") {
  const auto run = [](bool access) {
    Code code;
    code.add("setp.eq.u32", {0, special(isa::Special::LaneId), code.constant(99)});
    if (access) code.add("ld.global.b32", {reg(4), reg(2)}, 0, 0);
    code.add("exit");
    OneCore core(code, quick_params(), {});
    return core.run();
  };
  CHECK(run(false) == 2);
  CHECK(run(true) == 4 + 2);  // the comparison, the load, the exit
}

TEST_CASE("a called shader begins when its record is there, or its branch resolved if that is later") {
  Params params = quick_params();
  const Cycle branch = params.units.branch.latency;
  Cycle waited = 0;
  // The sum has the index, the unit's 12 and the memory's 20, the return, which is a branch, and the exit.
  const Cycle one = call_of_callables(params, 1, waited);
  CHECK(one == 4 + 12 + 20 + branch + 1);
  CHECK(waited == 12 + 20 - 1);
  // Four records are a line, whose sectors hold the door for two cycles. Then comes the line of the fifth
  // record.
  CHECK(call_of_callables(params, 4, waited) == one);
  CHECK(call_of_callables(params, 5, waited) == one + 2);
  params.units.branch.latency = 12 + 20;
  CHECK(call_of_callables(params, 1, waited) == one + 12 + 20 - branch);
  params.units.branch.latency = 12 + 20 + 1;
  CHECK(call_of_callables(params, 1, waited) == one + 2 * (12 + 20 + 1 - branch) - (12 + 20 - branch));
}

TEST_CASE("the last warp's exit opens a barrier for the others, 13 cycles later") {
  Code code;
  const isa::Slot zero = code.constant(0);
  code.add("setp.ge.u32", {1, special(isa::Special::TidX), code.constant(32)});
  const int skip = code.add("bra", {}, 0, 1);
  code.add("bar.sync", {zero, zero});
  code.add("exit");
  code.set_target(skip, code.here());
  for (int i = 0; i < 20; ++i) code.add("add.u32", {reg(1), reg(1), reg(1)});
  const int last = code.add("exit");
  OneCore core(code, quick_params(), {.num_warps = 2, .block_threads = 64});

  // The comparison and the branch take 4 each, then come twenty additions. The exit is in cycle 8 + 19 * 4 +
  // 1, and the other's exit comes after the barrier.
  CHECK(core.run() == 8 + 19 * 4 + 1 + 13 + 1);
  CHECK(last == 24);
}

TEST_CASE(
    "loads that want several words of a bank hold the door that long, and more of the latency where turns "
    "take more") {
  Params params = quick_params();
  params.lsu.bank_conflicts = true;
  params.lsu.lines_per_cycle = 8;
  params.lsu.sectors_per_cycle = 4;
  params.units.lsu = {12, 1};
  params.lsu.accept_interval = 1;
  const Cycle base = two_loads(params, 4);
  CHECK(base == 4 + 1 + 12 + 20 + 2);
  CHECK(two_loads(params, 8) == base + 2);       // two turns each: one more than the tags take
  CHECK(two_loads(params, 32) == base + 2 * 7);  // eight turns
  params.shared.conflict_turn = 3;
  // There are 21 cycles instead of 7, which overlap except for those of the door.
  CHECK(two_loads(params, 32) == base + 2 * 7 + 2 * 7);
  params.lsu.lines_per_cycle = 4;
  params.shared.conflict_turn = 1;
  CHECK(two_loads(params, 32) ==
        base + 2 * 7 +
            1);  // the tags take two of the eight turns, of which the latency does not hide the second
}

TEST_CASE(
    "a fence among cores ends with the turn in which it was issued, and alone with its latency and its "
    "pipe") {
  const std::string fences = "    membar.gl;\n    membar.gl;\n    exit;\n";
  CHECK(machine_cycles(fences, 1) == 2 + 2 + 1);   // an instruction in two cycles
  CHECK(machine_cycles(fences, 2) == 2 * 49 + 1);  // turns of 49 cycles: the ways between cores and slices
}

}  // namespace glint::core
