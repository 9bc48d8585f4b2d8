// Tests calls, recursion and indexed branches, with lanes that go different ways.
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "exec/executor.h"
#include "tests/support/catch.h"
#include "tests/unit/exec/text_launch.h"

namespace glint::exec {

TEST_CASE("a function returns to each of its callers") {
  TextLaunch launch(kOwnWord + R"(
    mov.b32 %r6, %r4;
    call TWICE;
    call TWICE;
    add.u32 %r6, %r6, 1;
    call TWICE;
    st.global.b32 [%rd2], %r6;
    exit;
TWICE:
    add.u32 %r6, %r6, %r6;
    ret;
)",
                    {});
  launch.run();

  for (uint32_t i = 0; i < 32; ++i) CHECK(launch.word(i) == 8 * i + 2);
}

TEST_CASE("only the lanes of the guard call, and lanes that return early wait for the others") {
  TextLaunch launch(kOwnWord + R"(
    mov.b32 %r6, 0;
    setp.lt.u32 %p1, %r4, 20;
    @%p1 call F;
    vote.sync.ballot.b32 %r7, %p1, 0xffffffff;
    activemask.b32 %r8;
    add.u32 %r6, %r6, %r8;
    st.global.b32 [%rd2], %r6;
    exit;
F:
    setp.lt.u32 %p2, %r4, 7;
    mov.b32 %r6, 1;
    @%p2 ret;
    mov.b32 %r6, 2;
    ret;
)",
                    {});
  launch.run();

  for (uint32_t i = 0; i < 32; ++i) CHECK(launch.word(i) == 0xffff'ffff + (i < 7 ? 1u : i < 20 ? 2u : 0u));
}

TEST_CASE("recursion of a different depth in each lane works through the stack pointer") {
  // The program computes f(n) = n == 0 ? 0 : n + f(n - 1), with a frame of one word.
  TextLaunch launch(kOwnWord + R"(
    mov.b32 %r6, %r4;
    call SUM;
    st.global.b32 [%rd2], %r7;
    exit;
SUM:
    mov.b32 %r7, 0;
    setp.eq.u32 %p1, %r6, 0;
    @%p1 ret;
    st.local.b32 [%r0], %r6;
    add.u32 %r0, %r0, 4;
    sub.u32 %r6, %r6, 1;
    call SUM;
    sub.u32 %r0, %r0, 4;
    ld.local.b32 %r6, [%r0];
    add.u32 %r7, %r7, %r6;
    ret;
)",
                    {.local_bytes = 32 * 4});
  launch.run();

  for (uint32_t i = 0; i < 32; ++i) CHECK(launch.word(i) == i * (i + 1) / 2);
}

TEST_CASE("recursion without end is a fault") {
  TextLaunch launch("    call F;\n    exit;\nF:\n    call F;\n    ret;\n", {});

  CHECK(launch.fault().find("calls are nested without end") != std::string::npos);
}

TEST_CASE("an indexed branch sends each lane to its own of three targets, and they meet again") {
  TextLaunch launch(kOwnWord + R"(
    rem.u32 %r5, %r4, 3;
    ssy MEET;
    brx.idx %r5, TABLE;
TABLE:
    bra ZERO;
    bra ONE;
    bra TWO;
ZERO:
    mov.b32 %r6, 100;
    bra MEET;
ONE:
    mov.b32 %r6, 200;
    bra MEET;
TWO:
    mov.b32 %r6, 300;
MEET:
    join;
    activemask.b32 %r7;
    popc.b32 %r7, %r7;
    add.u32 %r6, %r6, %r7;
    st.global.b32 [%rd2], %r6;
    exit;
)",
                    {});
  launch.run();

  for (uint32_t i = 0; i < 32; ++i) CHECK(launch.word(i) == 100 * (i % 3 + 1) + 32);
}

TEST_CASE("an indexed branch past its table is a fault") {
  TextLaunch launch(R"(
    ssy MEET;
    brx.idx %laneid, TABLE;
TABLE:
    bra MEET;
    bra MEET;
MEET:
    join;
    exit;
)",
                    {});

  CHECK(launch.fault().find("entry 2 of a table") != std::string::npos);
}

TEST_CASE(
    "a function that an any-hit shader calls decides nothing about its candidate; the shader's own return "
    "does") {
  std::vector<isa::Program> programs;
  programs.push_back(isa::parse(
      ".program \"caller\"\n.stage ray_generation\n.registers 8\n\n    nop_place: exit;\n    exit;\n",
      "caller"));
  programs.push_back(isa::parse(
      ".program \"hit\"\n.stage any_hit\n.registers 8\n\n    call F;\n    ret;\nF:\n    ret;\n", "hit"));
  const Image image = link(programs);
  mem::AddressSpace memory;
  World world;
  world.image = &image;
  world.memory = &memory;
  world.raygen = 0;
  world.constant_bank.resize(isa::kConstantBankBytes);
  world.launch_size = {32, 1, 1};
  Executor executor(world);
  WarpContext warp;
  executor.start(warp, 0);
  warp.frames.push_back(std::make_unique<TraceFrame>());
  warp.traced = std::make_unique<std::array<rt::RayState, kLanes>>();
  warp.depth = 1;
  rt::RayState& state = warp.ray(0);
  state.status = rt::RayStatus::NeedsAnyHit;
  state.candidate.t = 1.0f;
  // This is the state that call.sbt.candidate leaves: the caller waits at its second instruction, and lane 0
  // runs the any-hit shader.
  warp.simt.push_call(1, kAllLanes & ~1u, 1, 0);
  warp.simt.active = 1;
  warp.simt.pc = image.shaders[1].entry;

  executor.execute(warp, 0);  // call
  executor.execute(warp, 0);  // the function's ret
  CHECK(state.status == rt::RayStatus::NeedsAnyHit);
  CHECK(warp.simt.pc == image.shaders[1].entry + 1);
  executor.execute(warp, 0);  // the shader's ret
  CHECK(state.status != rt::RayStatus::NeedsAnyHit);
  CHECK(warp.simt.active == kAllLanes);
  CHECK(warp.simt.pc == 1);
}

TEST_CASE("a warp has rows for the specials that its program reads, and for the place of its threads") {
  const std::vector<isa::Program> programs{isa::parse(
      ".program \"hit\"\n.stage any_hit\n.registers 8\n\n    mov.b32 %r1, %hit.t;\n    ret;\n", "hit")};
  const Image image = link(programs);
  const auto row = [&](isa::Special special) { return image.special_row[size_t(special)]; };

  CHECK(row(isa::Special::LaneId) == 0);
  CHECK(row(isa::Special::LaunchZ) == 3);
  CHECK(row(isa::Special::HitT) == 4);
  CHECK(row(isa::Special::Payload) == Image::kNoRow);
  CHECK(image.num_special_rows == 5);
  CHECK(image.code[0].inst.operand[1] == isa::kSpecialBank + 4);
}

}  // namespace glint::exec
