// Tests further hazards: registers that memory instructions still read, the order of writes, register banks.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "tests/support/catch.h"
#include "tests/timing/core_programs.h"

namespace glint::core {
namespace {

using isa::Special;

// Returns the address of a buffer, which is the same in every space that has nothing before it.
Address first_buffer() {
  mem::AddressSpace space;
  return space.allocate("buffer", 4096);
}

// Sets %rd2 = buffer + 4 * lane, which takes 4 cycles from cycle 0 on.
void add_address(Code& code) {
  code.add("mad.wide.u32",
           {reg(2), special(Special::LaneId), code.constant(4), code.constant64(first_buffer())});
}

// Runs with a buffer in memory.
struct WithBuffer : OneCore {
  WithBuffer(Code& code, const Params& params, Options options = {}) : OneCore(code, params, options) {
    REQUIRE(memory.allocate("buffer", 4096) == first_buffer());
    cycles = run();
    REQUIRE_FALSE(cell->fault());
  }
  Cycle cycles = 0;
};

}  // namespace

TEST_CASE("a load's address can be overwritten its latency after it, not a cycle before") {
  for (uint32_t latency : {1u, 2u, 11u, 20u}) {
    CAPTURE(latency);
    Code code;
    add_address(code);
    code.add("ld.global.b32", {reg(4), reg(2)});      // 4
    code.add("mov.b32", {reg(2), code.constant(7)});  // 4 + latency
    code.add("exit");
    Params params = quick_params();
    params.lsu.war_latency = latency;
    const WithBuffer core(code, params);

    CHECK(stall(core, Stall::OperandRead) == latency - 1);
    CHECK(core.cycles == 37);  // the load comes back in cycle 36, whoever waits for its operands
  }
}

TEST_CASE("a store holds its data as well, and its guard it does not") {
  for (const bool guard : {false, true}) {
    Code code;
    add_address(code);
    const uint8_t always = guard ? 1 : isa::kNoGuard;
    code.add("setp.eq.u32", {1, reg(7), reg(7)});  // 2
    code.add("st.global.b32", {reg(2), reg(4)}, 0, always);
    if (guard)
      code.add("setp.eq.u32", {1, reg(7), reg(8)});
    else
      code.add("mov.b32", {reg(4), code.constant(7)});
    code.add("exit");
    Params params = quick_params();
    params.lsu.war_latency = 11;
    const WithBuffer core(code, params);

    CHECK(stall(core, Stall::OperandRead) == (guard ? 0 : 10));
  }
}

TEST_CASE("a load that waits in its queue holds its operands as long") {
  Code code;
  add_address(code);
  for (int i = 0; i < 3; ++i) code.add("ld.global.b32", {reg(4 + i), reg(2)});  // 4, 5, 6: taken in 5, 9, 13
  code.add("mov.b32", {reg(2), code.constant(7)});
  code.add("exit");
  Params params = quick_params();
  params.lsu.war_latency = 11;
  const WithBuffer core(code, params);

  CHECK(stall(core, Stall::OperandRead) == 12 + 11 - 7);  // 7 to 22
}

TEST_CASE("shared memory has a latency of its own for them") {
  Code code;
  code.add("ld.shared.b32", {reg(4), reg(2)});
  code.add("mov.b32", {reg(2), code.constant(7)});
  code.add("exit");
  Params params = quick_params();
  params.lsu.war_latency = 11;
  params.lsu.shared_war_latency = 9;
  OneCore core(code, params, {.block_threads = 32, .shared_bytes = 256});
  core.run();

  CHECK(stall(core, Stall::OperandRead) == 8);
}

TEST_CASE("a register that a load has not read holds up no other warp") {
  Code code;
  add_address(code);
  code.add("ld.global.b32", {reg(4), reg(2)});
  code.add("mov.b32", {reg(2), code.constant(7)});
  code.add("exit");
  Params params = quick_params();
  params.schedulers = 1;
  params.units.move.interval = params.units.integer.interval = 1;
  params.lsu.war_latency = 11;
  const WithBuffer core(code, params, {.num_warps = 2});

  // Warp 0 loads in 4 and overwrites in 15; warp 1 loads in 5, is taken in 9 and overwrites in 19.
  CHECK(core.stats().instructions.value() == 8);
  CHECK(stall(core, Stall::OperandRead) == (15 - 6) + (19 - 17));
}

TEST_CASE("a result need not wait for an earlier one of its register that comes before it") {
  for (const uint32_t crossing : {0u, 1u})
    for (const bool order : {false, true}) {
      CAPTURE(crossing, order);
      Code code;
      code.add("sin.f32", {reg(1), reg(0)});          // 0, done in 21
      code.add("add.u32", {reg(1), reg(2), reg(2)});  // 18, done in 22; in order: 21
      code.add("exit");
      Params params = quick_params();
      params.pipe_crossing = crossing;
      params.write_order = order;
      OneCore core(code, params, {});

      CHECK(core.run() == (order ? 21u : 18u) + 2);
    }
}

TEST_CASE("results of one pipe overwrite each other at its interval") {
  Code code;
  for (int i = 0; i < 10; ++i) code.add("add.u32", {reg(1), reg(2), reg(2)});
  code.add("exit");
  Params params = quick_params();
  params.write_order = false;
  OneCore core(code, params, {});

  CHECK(core.run() == 9 * 2 + 2);
}

TEST_CASE("what depends on a register waits for the last of its writers") {
  Code code;
  code.add("sin.f32", {reg(1), reg(0)});
  code.add("add.u32", {reg(1), reg(2), reg(2)});  // 18
  code.add("add.u32", {reg(3), reg(1), reg(1)});  // 22
  code.add("exit");
  Params params = quick_params();
  params.write_order = false;
  OneCore core(code, params, {});

  CHECK(core.run() == 22 + 2);
}

// The code is the listing of "Analyzing Modern NVIDIA GPU cores", MICRO 2025, section 5.3: none, one and two
// bubbles.
TEST_CASE("registers of one bank are read one a cycle, within the window") {
  const auto run = [](int second, int third, uint32_t banks, uint32_t window = 3) {
    Code code;
    code.add("fma.rn.f32", {reg(11), reg(10), reg(12), reg(14)});
    code.add("fma.rn.f32", {reg(13), reg(16), reg(second), reg(third)});
    code.add("exit");
    Params params = quick_params();
    params.units.fp32.interval = 1;
    params.register_file = {banks, window};
    OneCore core(code, params, {});
    const Cycle cycles = core.run();
    CHECK(core.stats().stalls.count(Stall::RegisterBanks) == cycles - 3);
    return cycles;
  };

  CHECK(run(19, 21, 2) == 3);
  CHECK(run(18, 21, 2) == 4);
  CHECK(run(18, 20, 2) == 5);
  CHECK(run(18, 20, 0) == 3);  // no banks
  CHECK(run(18, 22, 4) == 3);  // of four banks: 10, 14, 18 and 22 in one, two an instruction
  CHECK(run(18, 22, 4, 2) == 4);
}

TEST_CASE("constants take no port of the register file") {
  Code code;
  for (int i = 0; i < 4; ++i)
    code.add("fma.rn.f32", {reg(11 + i), reg(10), code.constant(1), code.constant(2)});
  code.add("exit");
  Params params = quick_params();
  params.units.fp32.interval = 1;
  params.register_file.banks = 2;
  OneCore core(code, params, {});

  CHECK(core.run() == 5);
}

TEST_CASE("blocks start on a core at their interval") {
  for (uint32_t interval : {0u, 1u, 7u}) {
    Code code;
    code.add("exit");
    Params params = quick_params();
    params.block_interval = interval;
    OneCore core(code, params, {.num_warps = 4});

    CHECK(core.run() == 3 * interval + 1);
  }
}

}  // namespace glint::core
