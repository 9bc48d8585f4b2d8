// Tests to the cycle when blocks, barriers, shared memory, atomics and fences let a warp go on.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "tests/support/catch.h"
#include "tests/timing/core_programs.h"
#include "tests/unit/core/one_core.h"

namespace glint::core {
namespace {

using isa::Special;

// Sets %r2 = laneid * stride, a shared address.
void add_shared_address(Code& code, uint32_t stride) {
  code.add("mul.lo.u32", {reg(2), special(Special::LaneId), code.constant(stride)});
}

// Returns the cycles of one warp that loads from shared memory at a stride and uses the value.
Cycle load_cycles(uint32_t stride, std::string_view op = "ld.shared.b32",
                  const Params& params = quick_params()) {
  Code code;
  add_shared_address(code, stride);
  if (op.find(".cas.") != std::string_view::npos)
    code.add(op, {reg(4), reg(2), reg(2), reg(2)});
  else if (op.starts_with("atom"))
    code.add(op, {reg(4), reg(2), reg(2)});
  else
    code.add(op, {reg(4), reg(2)});
  code.add("add.u32", {reg(5), reg(4), reg(4)});
  code.add("exit");
  OneCore core(code, params, {.num_warps = 1, .block_threads = 32, .shared_bytes = 8192});
  return core.run();
}

}  // namespace

TEST_CASE("a barrier takes 13 cycles and 2 for each warp of the block") {
  for (const uint32_t warps : {1u, 2u, 8u, 32u}) {
    CAPTURE(warps);
    Code code;
    const isa::Slot zero = code.constant(0);
    code.add("bar.sync", {zero, zero});
    code.add("exit");
    OneCore core(code, quick_params(), {.num_warps = warps, .block_threads = warps * 32});

    const Cycle end = core.run();

    // First comes the release, and then the exits of each scheduler's warps, two cycles apart.
    CHECK(end == 13 + 2 * warps + 2 * ((warps + 3) / 4 - 1) + 1);
    CHECK(core.stats().barriers.value() == warps);
  }
}

TEST_CASE("a warp waits at a barrier for one that comes late, and for nobody of another block") {
  Code code;
  const isa::Slot zero = code.constant(0);
  code.add("setp.lt.u32", {1, special(Special::TidX), code.constant(32)});
  code.add("ssy", {}, 4);
  code.add("bra", {}, 4, 1);
  code.add("sin.f32", {reg(1), reg(1)});
  code.add("join");
  code.add("setp.eq.u32", {1, reg(1), reg(1)});
  code.add("bar.sync", {zero, zero});
  code.add("exit");
  OneCore alone(code, quick_params(), {.num_warps = 1, .block_threads = 32});
  OneCore both(code, quick_params(), {.num_warps = 2, .block_threads = 64});

  const Cycle early = alone.run(), late = both.run();

  CHECK(late >= early + 15);  // the sine's 21 cycles, less the branch that the other takes
  CHECK(stall(both, Stall::Barrier) >= stall(alone, Stall::Barrier) + 15);
}

TEST_CASE("a load from shared memory takes 23 cycles, and one more for each further word of a bank") {
  const Cycle base = 4 + 23 + 2;  // address, load, add, exit
  CHECK(load_cycles(4) == base);
  CHECK(load_cycles(0) == base);         // one word for all
  CHECK(load_cycles(8) == base + 1);     // 2 words per bank
  CHECK(load_cycles(128) == base + 31);  // all in one bank
  CHECK(load_cycles(132) == base);       // each in a bank of its own
  CHECK(load_cycles(1, "ld.shared.u8") == base);
}

TEST_CASE("atomics on shared memory take turns where lanes meet") {
  const Cycle base = 4 + 76 + 2;
  CHECK(load_cycles(4, "atom.shared.add.u32") == base);
  CHECK(load_cycles(0, "atom.shared.add.u32") == base + 31 * 2);
}

TEST_CASE(
    "a compare-and-swap and a floating-point addition in shared memory have times of their own, of whose "
    "turns some are hidden") {
  Params params = quick_params();
  params.shared.atomic_hidden = 12;
  params.shared.swap = {126, 4, 17};
  params.shared.float_add = {195, 94, 0};
  const auto cycles = [&](uint32_t stride, std::string_view op) {
    return load_cycles(stride, op, params) - (4 + 2);
  };

  CHECK(cycles(4, "atom.shared.add.u32") == 76);
  CHECK(cycles(0, "atom.shared.add.u32") == 76 + 31 * 2 - 12);
  CHECK(cycles(32, "atom.shared.add.u32") == 76 + 7 * 2 - 12);  // 8 lanes per bank
  CHECK(cycles(16, "atom.shared.add.u32") == 76);               // 4: three turns are hidden
  CHECK(cycles(4, "atom.shared.cas.b32") == 126);
  CHECK(cycles(0, "atom.shared.cas.b32") == 126 + 31 * 4 - 17);
  CHECK(cycles(4, "atom.shared.add.f32") == 195);
  CHECK(cycles(0, "atom.shared.add.f32") == 195 + 31 * 94);
  params.shared.swap = params.shared.float_add = {};
  CHECK(cycles(0, "atom.shared.cas.b32") == cycles(0, "atom.shared.add.u32"));
  CHECK(cycles(0, "atom.shared.add.f32") == cycles(0, "atom.shared.add.u32"));
}

TEST_CASE("shared memory serves conflicting accesses at one pass a cycle") {
  Code code;
  add_shared_address(code, 128);
  for (int i = 0; i < 4; ++i) code.add("ld.shared.b32", {reg(4 + i), reg(2)});
  code.add("add.u32", {reg(9), reg(7), reg(7)});
  code.add("exit");
  OneCore core(code, quick_params(), {.num_warps = 1, .block_threads = 32, .shared_bytes = 8192});

  CHECK(core.run() == 4 + 23 + 31 + 3 * 32 + 2);
  CHECK(core.stats().shared_passes.value() == 4 * 32);
  CHECK(core.stats().shared_loads.value() == 4);
  CHECK(core.stats().accesses.value() == 0);  // nothing went to the L1
}

TEST_CASE("global atomics travel to the memory as such, and only those with a result are waited for") {
  for (const bool returns : {true, false}) {
    Code code;
    mem::AddressSpace sizes;  // the address is the same in every space: the first allocation
    const Address base = sizes.allocate("buffer", 4096);
    const isa::Slot at = code.constant64(base), one = code.constant(1);
    if (returns)
      code.add("atom.global.add.u32", {reg(4), at, one});
    else
      code.add("red.global.add.u32", {at, one});
    code.add("add.u32", {reg(5), reg(4), reg(4)});
    code.add("exit");
    OneCore core(code, quick_params(), {});
    REQUIRE(core.memory.allocate("buffer", 4096) == base);

    core.run();

    REQUIRE(core.l1.log().size() == 1);
    CHECK(core.l1.log()[0].traffic == mem::Traffic::ShaderAtomic);
    CHECK(core.l1.log()[0].write == !returns);
    CHECK((stall(core, Stall::LongScoreboard) > 0) == returns);
    CHECK(core.stats().global_atomics.value() == 1);
    CHECK(core.memory.view<uint32_t>(base, 1)[0] == 32);
  }
}

TEST_CASE("the result of an atomic on global memory comes later than a load's by the atomics' latency") {
  const auto run = [](bool atomic, uint32_t latency) {
    Code code;
    mem::AddressSpace sizes;
    const isa::Slot at = code.constant64(sizes.allocate("buffer", 4096)), one = code.constant(1);
    if (atomic)
      code.add("atom.global.add.u32", {reg(4), at, one});
    else
      code.add("ld.global.b32", {reg(4), at});
    code.add("add.u32", {reg(5), reg(4), reg(4)});
    code.add("exit");
    Params params = quick_params();
    params.lsu.atomic_latency = latency;
    OneCore core(code, params, {});
    core.memory.allocate("buffer", 4096);
    return core.run();
  };

  CHECK(run(true, 204) - run(true, 0) == 204);
  CHECK(run(false, 204) == run(false, 0));
  CHECK(run(true, 0) == run(false, 0));
}

TEST_CASE("a fence of the GPU waits for the acknowledgement of a store since the last one, others do not") {
  const auto run = [](std::string_view fence, bool store, uint32_t acknowledgement) {
    Code code;
    mem::AddressSpace sizes;
    const isa::Slot at = code.constant64(sizes.allocate("buffer", 4096));
    if (store) code.add("st.global.b32", {at, reg(4)});
    code.add(fence);
    code.add(fence);
    code.add("exit");
    Params params = quick_params();
    params.fence.acknowledgement = acknowledgement;
    OneCore core(code, params, {});
    core.memory.allocate("buffer", 4096);
    return core.run();
  };

  CHECK(run("membar.gl", true, 285) - run("membar.gl", true, 0) == 285);
  CHECK(run("membar.gl", false, 285) == run("membar.gl", false, 0));
  CHECK(run("membar.sys", true, 285) == run("membar.sys", true, 0));
  CHECK(run("membar.cta", true, 285) == run("membar.cta", true, 0));
}

TEST_CASE("a fence waits for the warp's accesses and then for its scope's time") {
  const auto run = [](std::string_view fence, bool access) {
    Code code;
    mem::AddressSpace sizes;
    const isa::Slot at = code.constant64(sizes.allocate("buffer", 4096));
    if (access) code.add("ld.global.b32", {reg(4), at});
    code.add(fence);
    code.add("exit");
    OneCore core(code, quick_params(), {});
    core.memory.allocate("buffer", 4096);
    return core.run();
  };

  CHECK(run("membar.cta", false) == 36 + 1);
  CHECK(run("membar.gl", false) == 289 + 1);
  CHECK(run("membar.gl", true) == 12 + OneCore::kMemoryLatency + 289 + 1);
  CHECK(run("membar.sys", false) == 1055 + 1);
}

TEST_CASE("a core takes as many blocks as its slots, its shared memory and its places hold") {
  const auto most_at_once = [](uint32_t threads, uint32_t shared_bytes, uint32_t blocks) {
    Code code;
    code.add("sin.f32", {reg(1), reg(1)});
    code.add("add.u32", {reg(2), reg(1), reg(1)});
    code.add("exit");
    Params params = quick_params();
    params.blocks = blocks;
    params.shared_bytes = 4096;
    OneCore core(code, params, {.num_warps = 32, .block_threads = threads, .shared_bytes = shared_bytes});
    core.run();
    CHECK(core.stats().blocks.value() == 32 * 32 / threads);
    CHECK(core.stats().warps.value() == 32);
    return double(core.stats().resident_cycles.value()) / double(core.stats().cycles.value());
  };

  // The mean numbers of resident warps are: all 32; 4 at a time by shared memory; 2 blocks of 4 warps.
  CHECK(most_at_once(64, 0, 16) > 20);
  CHECK(most_at_once(32, 1024, 16) <= 4);
  CHECK(most_at_once(32, 1024, 16) > 2);
  CHECK(most_at_once(128, 0, 2) <= 8);
}

TEST_CASE("a block that fits no core is reported with what would do") {
  Params params;
  Diagnostics fits, threads, shared, warps;
  check_block(params, 32, 1024, 65536, fits);
  check_block(params, 32, 1025, 0, threads);
  check_block(params, 32, 32, 65537, shared);
  check_block(params, 64, 1024, 0, warps);

  CHECK_FALSE(fits.has_errors());
  CHECK(threads.has_errors());
  REQUIRE(shared.has_errors());
  CHECK(shared.messages()[0].find("core.shared_bytes to 65537") != std::string::npos);
  REQUIRE(warps.has_errors());
  CHECK(warps.messages()[0].find("32 warps, and 16 fit") != std::string::npos);
}

TEST_CASE("blocks with barriers and conflicts take the same cycles whether idle time is skipped or not") {
  const auto run = [](bool no_skip) {
    Code code;
    const isa::Slot zero = code.constant(0);
    add_shared_address(code, 20);
    code.add("st.shared.b32", {reg(2), reg(2)});
    code.add("membar.cta");
    code.add("bar.sync", {zero, zero});
    code.add("atom.shared.add.u32", {reg(4), zero, reg(2)});
    code.add("setp.lt.u32", {1, special(Special::TidX), code.constant(64)});
    code.add("exit", {}, 0, 1);
    code.add("bar.red.popc.u32", {reg(6), zero, zero, 1});
    code.add("ld.shared.v4.b32", {reg(8), reg(9), reg(10), reg(11), zero});
    code.add("add.u32", {reg(12), reg(6), reg(8)});
    code.add("exit");
    OneCore core(code, quick_params(),
                 {.num_warps = 64, .no_skip = no_skip, .block_threads = 128, .shared_bytes = 1024});
    const Cycle end = core.run();
    std::vector<uint64_t> out{end};
    for (int s = 0; s < int(Stall::Count); ++s) out.push_back(core.stats().stalls.count(Stall(s)));
    return out;
  };

  CHECK(run(false) == run(true));
}

}  // namespace glint::core
