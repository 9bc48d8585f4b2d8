// Tests atomics: what they leave, what they return, and that no lane's turn is lost.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstdint>
#include <set>

#include "tests/support/catch.h"
#include "tests/unit/exec/text_launch.h"

namespace glint::exec {
namespace {

// Holds the outcome of `op` on word 0, which held `old`, by one thread: what the op returned, and what it
// left.
struct Outcome {
  uint64_t returned, left;
  bool operator==(const Outcome&) const = default;
};
Outcome run_one(const std::string& op, bool wide, uint64_t old, uint64_t b, uint64_t c = 0) {
  const bool swap = op.find(".cas.") != std::string::npos;
  std::string text =
      "    ld.param.b64 %rd2, [0];\n    ld.param.b64 %rd4, [8];\n    ld.param.b64 %rd6, [16];\n";
  text += wide ? "    " + op + " %rd8, [%rd2], %rd4" + (swap ? ", %rd6" : "") +
                     ";\n    st.global.b64 [%rd2 + 8], %rd8;\n"
               : "    " + op + " %r8, [%rd2], %r4" + (swap ? ", %r6" : "") +
                     ";\n    st.global.b32 [%rd2 + 8], %r8;\n";
  TextLaunch launch(text + "    exit;\n", {.block = {1, 1, 1}});
  launch.memory.write(launch.buffer, &old, 8);
  std::memcpy(launch.world.constant_bank.data() + isa::kPushConstantOffset + 8, &b, 8);
  std::memcpy(launch.world.constant_bank.data() + isa::kPushConstantOffset + 16, &c, 8);
  launch.run();
  const auto memory = launch.memory.view<uint64_t>(launch.buffer, 2);
  return {memory[1], memory[0]};
}
uint32_t bits_of(float x) {
  return std::bit_cast<uint32_t>(x);
}
uint64_t bits_of(double x) {
  return std::bit_cast<uint64_t>(x);
}

}  // namespace

TEST_CASE("integer atomics return the old value and leave the new one") {
  CHECK(run_one("atom.global.add.u32", false, 0xffff'ffff, 2) == Outcome{0xffff'ffff, 1});
  CHECK(run_one("atom.global.add.u64", true, 0xffff'ffff, 2) == Outcome{0xffff'ffff, 0x1'0000'0001});
  CHECK(run_one("atom.global.min.s32", false, 0xffff'ffff, 2) == Outcome{0xffff'ffff, 0xffff'ffff});
  CHECK(run_one("atom.global.min.u32", false, 0xffff'ffff, 2) == Outcome{0xffff'ffff, 2});
  CHECK(run_one("atom.global.max.s64", true, 0xffff'ffff'ffff'ffff, 2) == Outcome{0xffff'ffff'ffff'ffff, 2});
  CHECK(run_one("atom.global.inc.u32", false, 4, 5) == Outcome{4, 5});
  CHECK(run_one("atom.global.inc.u32", false, 5, 5) == Outcome{5, 0});
  CHECK(run_one("atom.global.dec.u32", false, 0, 5) == Outcome{0, 5});
  CHECK(run_one("atom.global.dec.u32", false, 6, 5) == Outcome{6, 5});
  CHECK(run_one("atom.global.xor.b32", false, 6, 5) == Outcome{6, 3});
  CHECK(run_one("atom.global.exch.b64", true, 6, 0x5'0000'0000) == Outcome{6, 0x5'0000'0000});
  CHECK(run_one("atom.global.cas.b32", false, 6, 6, 9) == Outcome{6, 9});
  CHECK(run_one("atom.global.cas.b32", false, 7, 6, 9) == Outcome{7, 7});
}

TEST_CASE("atomics of 16 bits leave the neighbouring half word alone") {
  CHECK(run_one("atom.global.cas.b16", false, 0xabcd'0006, 0x1111'0006, 0x2222'0009) ==
        Outcome{6, 0xabcd'0009});
  CHECK(run_one("atom.global.add.noftz.f16", false, 0xabcd'3c00, 0x3c00) == Outcome{0x3c00, 0xabcd'4000});
  CHECK(run_one("atom.global.add.noftz.bf16x2", false, 0x3f80'3f80, 0x3f80'0000) ==
        Outcome{0x3f80'3f80, 0x4000'3f80});
}

TEST_CASE("float atomics add, and take the number of a number and a NaN") {
  CHECK(run_one("atom.global.add.f32", false, bits_of(1.5f), bits_of(2.0f)) ==
        Outcome{bits_of(1.5f), bits_of(3.5f)});
  CHECK(run_one("atom.add.f64", true, bits_of(1.5), bits_of(-2.0)) == Outcome{bits_of(1.5), bits_of(-0.5)});
  CHECK(run_one("atom.global.min.f32", false, bits_of(-0.0f), bits_of(0.0f)) ==
        Outcome{bits_of(-0.0f), bits_of(-0.0f)});
  CHECK(run_one("atom.global.max.f32", false, bits_of(-0.0f), bits_of(0.0f)) ==
        Outcome{bits_of(-0.0f), bits_of(0.0f)});
  CHECK(run_one("atom.global.min.f32", false, bits_of(-1.0f), bits_of(-2.0f)) ==
        Outcome{bits_of(-1.0f), bits_of(-2.0f)});
  CHECK(run_one("atom.global.max.f64", true, bits_of(-1.0), bits_of(3.0)) ==
        Outcome{bits_of(-1.0), bits_of(3.0)});
  CHECK(run_one("atom.global.max.f32", false, 0x7fc0'0000, bits_of(-2.0f)) ==
        Outcome{0x7fc0'0000, bits_of(-2.0f)});
  CHECK(run_one("atom.global.min.f64", true, bits_of(2.0), 0xfff8'0000'0000'0001) ==
        Outcome{bits_of(2.0), bits_of(2.0)});
}

TEST_CASE("the adder of global memory flushes subnormals, that of shared memory keeps them") {
  TextLaunch launch(R"(
    ld.param.b64 %rd2, [0];
    red.shared.add.f32 [0], 1;
    cvta.shared.u64 %rd4, 0;
    red.add.f32 [%rd4], 1;
    red.global.add.f32 [%rd2], 1;
    red.add.f32 [%rd2], 1;
    ld.shared.b32 %r6, [0];
    st.global.b32 [%rd2 + 4], %r6;
    exit;
)",
                    {.block = {1, 1, 1}, .shared_bytes = 4});
  launch.run();

  CHECK(launch.word(0) == 0);
  CHECK(launch.word(1) == 2);
}

TEST_CASE("every lane of every warp gets a turn, and a value of its own") {
  for (const std::string op : {"atom.global.add.u32 %r8, [%rd2], 1", "atom.add.u32 %r8, [%rd2], 1",
                               "atom.global.inc.u32 %r8, [%rd2], 1000"}) {
    TextLaunch launch(R"(
    ld.param.b64 %rd2, [0];
    )" + op + R"(;
    mad.lo.u32 %r4, %ctaid.x, %ntid.x, %tid.x;
    mad.wide.u32 %rd6, %r4, 4, %rd2;
    st.global.b32 [%rd6 + 4], %r8;
    exit;
)",
                      {.grid = {3, 1, 1}, .block = {80, 1, 1}});
    launch.run();

    CHECK(launch.word(0) == 240);
    const std::vector<uint32_t> values = launch.words(1, 240);
    CHECK(std::set<uint32_t>(values.begin(), values.end()).size() == 240);
    CHECK(values[0] == 0);
    CHECK(values[31] == 31);  // lanes take turns, the lowest first
  }
}

TEST_CASE("shared atomics of two warps meet in one place") {
  TextLaunch launch(kOwnWord + R"(
    and.b32 %r5, %r4, 3;
    shl.b32 %r5, %r5, 2;
    red.shared.add.u32 [%r5], %r4;
    red.shared.max.u32 [16], %r4;
    bar.sync 0, 0;
    setp.lt.u32 %p1, %r4, 5;
    ssy DONE;
    @!%p1 bra DONE;
    shl.b32 %r5, %r4, 2;
    ld.shared.b32 %r6, [%r5];
    st.global.b32 [%rd2], %r6;
DONE:
    join;
    exit;
)",
                    {.block = {64, 1, 1}, .shared_bytes = 20});
  launch.run();

  CHECK(launch.words(0, 5) == std::vector<uint32_t>{480, 496, 512, 528, 63});
}

TEST_CASE("a lock built from compare-and-swap lets every thread of many warps through") {
  TextLaunch launch(R"(
    ld.param.b64 %rd2, [0];
    mov.b32 %r20, 0;
AGAIN:
    ssy NEXT;
    setp.ne.u32 %p3, %laneid, %r20;
    @%p3 bra NEXT;
TRY:
    atom.global.cas.b32 %r4, [%rd2], 0, 1;
    setp.ne.u32 %p1, %r4, 0;
    @%p1 bra TRY;
    ld.global.b32 %r5, [%rd2 + 4];
    add.u32 %r5, %r5, 1;
    st.global.b32 [%rd2 + 4], %r5;
    atom.global.exch.b32 %r6, [%rd2], 0;
NEXT:
    join;
    add.u32 %r20, %r20, 1;
    setp.lt.u32 %p2, %r20, 32;
    @%p2 bra AGAIN;
    exit;
)",
                    {.grid = {2, 1, 1}, .block = {128, 1, 1}});
  launch.run();

  CHECK(launch.word(0) == 0);
  CHECK(launch.word(1) == 256);
}

TEST_CASE("an atomic on local memory, and a misaligned one, are faults") {
  TextLaunch local("    cvta.local.u64 %rd2, 8;\n    red.add.u32 [%rd2], 1;\n    exit;\n",
                   {.local_bytes = 64});
  TextLaunch odd("    ld.param.b64 %rd2, [0];\n    red.global.add.u32 [%rd2 + 2], 1;\n    exit;\n", {});

  CHECK(local.fault().find("an atomic on local memory") != std::string::npos);
  CHECK(odd.fault().find("which is not a multiple of 4") != std::string::npos);
}

}  // namespace glint::exec
