// Tests blocks: the number of a thread, shared memory, barriers, and barriers that nobody completes.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "tests/support/catch.h"
#include "tests/unit/exec/text_launch.h"

namespace glint::exec {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// Sums the thread numbers of a block of any size into word %ctaid.x, by a tree over shared memory.
const std::string kReduce = R"(
    mov.b32 %r4, %tid.x;
    shl.b32 %r5, %r4, 2;
    st.shared.b32 [%r5], %r4;
    mov.b32 %r6, %ntid.x;
    shr.u32 %r6, %r6, 1;
    bar.sync 0, 0;
LOOP:
    ssy MEET;
    setp.ge.u32 %p1, %r4, %r6;
    @%p1 bra MEET;
    add.u32 %r7, %r4, %r6;
    shl.b32 %r7, %r7, 2;
    ld.shared.b32 %r8, [%r7];
    ld.shared.b32 %r9, [%r5];
    add.u32 %r9, %r9, %r8;
    st.shared.b32 [%r5], %r9;
MEET:
    join;
    bar.sync 0, 0;
    shr.u32 %r6, %r6, 1;
    setp.ne.u32 %p2, %r6, 0;
    @%p2 bra LOOP;
    setp.ne.u32 %p3, %r4, 0;
    ssy DONE;
    @%p3 bra DONE;
    ld.shared.b32 %r10, [0];
    ld.param.b64 %rd12, [0];
    mov.b32 %r14, %ctaid.x;
    mad.wide.u32 %rd12, %r14, 4, %rd12;
    st.global.b32 [%rd12], %r10;
DONE:
    join;
    exit;
)";

}  // namespace

TEST_CASE("warps of a block reduce over shared memory between barriers") {
  for (const uint32_t threads : {32u, 64u, 256u, 1024u}) {
    TextLaunch launch(kReduce, {.grid = {5, 1, 1}, .block = {threads, 1, 1}, .shared_bytes = threads * 4});
    launch.run();

    for (uint32_t block = 0; block < 5; ++block) CHECK(launch.word(block) == threads * (threads - 1) / 2);
  }
}

TEST_CASE("threads are numbered x fastest, and blocks too") {
  // Each thread writes one word, at its linear number in the launch: tid and ctaid packed into bytes.
  TextLaunch launch(R"(
    mad.lo.u32 %r4, %tid.z, %ntid.y, %tid.y;
    mad.lo.u32 %r4, %r4, %ntid.x, %tid.x;
    mad.lo.u32 %r5, %ctaid.z, %nctaid.y, %ctaid.y;
    mad.lo.u32 %r5, %r5, %nctaid.x, %ctaid.x;
    mad.lo.u32 %r6, %r5, 60, %r4;
    ld.param.b64 %rd2, [0];
    mad.wide.u32 %rd2, %r6, 4, %rd2;
    shl.b32 %r7, %tid.z, 8;
    or.b32 %r7, %r7, %tid.y;
    shl.b32 %r7, %r7, 8;
    or.b32 %r7, %r7, %tid.x;
    shl.b32 %r8, %launch.x, 24;
    or.b32 %r7, %r7, %r8;
    st.global.b32 [%rd2], %r7;
    exit;
)",
                    {.grid = {2, 2, 1}, .block = {5, 4, 3}});
  launch.run();

  for (uint32_t block = 0; block < 4; ++block)
    for (uint32_t thread = 0; thread < 60; ++thread) {
      const uint32_t x = thread % 5, y = thread / 5 % 4, z = thread / 20;
      CHECK(launch.word(block * 60 + thread) == (z << 16 | y << 8 | x | (block % 2 * 5 + x) << 24));
    }
}

TEST_CASE("a program reads lane masks, warp numbers and the sizes of shared memory") {
  TextLaunch launch(kOwnWord + R"(
    shl.b32 %r5, %warpid, 16;
    mad.lo.u32 %r5, %nwarpid, 256, %r5;
    popc.b32 %r6, %lanemask_lt;
    popc.b32 %r7, %lanemask_ge;
    mad.lo.u32 %r5, %r6, 1, %r5;
    mad.lo.u32 %r5, %r7, 1, %r5;
    sub.u32 %r8, %total_smem_size, %dynamic_smem_size;
    mad.lo.u32 %r5, %r8, 0x1000000, %r5;
    st.global.b32 [%rd2], %r5;
    exit;
)",
                    {.block = {96, 1, 1}, .shared_bytes = 24, .dynamic_bytes = 100});
  launch.run();

  for (uint32_t thread = 0; thread < 96; ++thread)
    CHECK(launch.word(thread) == (24u << 24 | thread / 32 << 16 | 3u << 8 | 32u));
}

TEST_CASE("shared memory is the block's own and starts as zeros") {
  TextLaunch launch(R"(
    ld.shared.b32 %r4, [0];
    bar.sync 0, 0;
    add.u32 %r4, %r4, 1;
    st.shared.b32 [0], %r4;
    ld.param.b64 %rd2, [0];
    mad.wide.u32 %rd2, %ctaid.x, 4, %rd2;
    st.global.b32 [%rd2], %r4;
    exit;
)",
                    {.grid = {3, 1, 1}, .block = {64, 1, 1}, .shared_bytes = 4});
  launch.run();

  CHECK(launch.words(0, 3) == std::vector<uint32_t>{1, 1, 1});
}

TEST_CASE("bar.red counts, ands and ors the predicates of all threads of the block") {
  TextLaunch launch(kOwnWord + R"(
    setp.lt.u32 %p1, %r4, 70;
    bar.red.popc.u32 %r5, 0, 0, %p1;
    bar.red.and.pred %p2, 1, 0, %p1;
    bar.red.or.pred %p3, 1, 0, %p1;
    selp.b32 %r6, 0x100, 0, %p2;
    selp.b32 %r7, 0x200, 0, %p3;
    or.b32 %r5, %r5, %r6;
    or.b32 %r5, %r5, %r7;
    st.global.b32 [%rd2], %r5;
    exit;
)",
                    {.block = {100, 1, 1}});
  launch.run();

  CHECK(launch.words(0, 100) == std::vector<uint32_t>(100, 70 + 0x200));
}

TEST_CASE("warps that arrive go on, and let those that wait pass") {
  // Warp 0 produces and arrives; warp 1 waits for both, then reads.
  TextLaunch launch(R"(
    ld.param.b64 %rd2, [0];
    setp.ge.u32 %p1, %tid.x, 32;
    ssy DONE;
    @%p1 bra CONSUME;
    st.shared.b32 [0], 42;
    bar.arrive 3, 64;
    bra DONE;
CONSUME:
    bar.sync 3, 64;
    ld.shared.b32 %r4, [0];
    st.global.b32 [%rd2], %r4;
DONE:
    join;
    exit;
)",
                    {.block = {64, 1, 1}, .shared_bytes = 4});
  launch.run();

  CHECK(launch.word(0) == 42);
}

TEST_CASE("warps that have ended are not waited for") {
  TextLaunch launch(kOwnWord + R"(
    setp.ge.u32 %p1, %r4, 40;
    @%p1 exit;
    bar.sync 0, 0;
    st.global.b32 [%rd2], 7;
    exit;
)",
                    {.block = {128, 1, 1}});
  launch.run();

  for (uint32_t thread = 0; thread < 128; ++thread) CHECK(launch.word(thread) == (thread < 40 ? 7u : 0u));
}

TEST_CASE("a barrier that nobody can complete is a fault with the places of those that wait") {
  TextLaunch launch(R"(
    setp.ge.u32 %p1, %tid.x, 96;
    ssy DONE;
    @%p1 bra DONE;
    bar.sync 2, 256;
DONE:
    join;
    exit;
)",
                    {.block = {256, 1, 1}});

  const std::string fault = launch.fault();
  CHECK(contains(fault,
                 "3 of 8 warps wait at bar.sync 2 (test (instruction 3: bar.sync)), the others have ended"));
}

TEST_CASE("warps that wait at different barriers are a fault that names both") {
  TextLaunch launch(R"(
    setp.ge.u32 %p1, %tid.x, 32;
    ssy DONE;
    @%p1 bra OTHER;
    bar.sync 0, 64;
    bra DONE;
OTHER:
    bar.sync 1, 64;
DONE:
    join;
    exit;
)",
                    {.block = {64, 1, 1}});

  const std::string fault = launch.fault();
  CHECK(contains(fault, "1 of 2 warps wait at bar.sync 0"));
  CHECK(contains(fault, "1 of 2 warps wait at bar.sync 1"));
}

TEST_CASE("a divided warp may not come to a barrier") {
  TextLaunch launch(R"(
    setp.ge.u32 %p1, %tid.x, 16;
    ssy DONE;
    @%p1 bra DONE;
    bar.sync 0, 0;
DONE:
    join;
    exit;
)",
                    {});

  CHECK(contains(launch.fault(),
                 "16 of the 32 lanes of the warp come to bar.sync, but all have to come together"));
}

TEST_CASE("barriers that are not there and counts that cannot be are faults") {
  const auto fault = [](const std::string& instruction) {
    TextLaunch launch("    " + instruction + "\n    exit;\n", {.block = {64, 1, 1}});
    return launch.fault();
  };
  CHECK(contains(fault("bar.sync 16, 0;"), "comes to barrier 16, and a block has 16"));
  CHECK(contains(fault("bar.sync 0, 33;"), "a multiple of 32"));
  CHECK(contains(fault("bar.sync 0, 96;"), "up to the block's 64"));
  CHECK(contains(fault("bar.arrive 0, 0;"), "has to say how many threads"));
}

TEST_CASE("a trap is a fault") {
  TextLaunch launch(R"(
    setp.eq.u32 %p1, %tid.x, 5;
    @%p1 trap;
    exit;
)",
                    {});

  CHECK(contains(launch.fault(), "launch id (5, 0, 0)"));
}

TEST_CASE("shared memory ends where the block's ends") {
  TextLaunch launch("    mov.b32 %r6, 64;\n    ld.shared.b32 %r4, [%r6];\n    exit;\n", {.shared_bytes = 64});

  CHECK(contains(
      launch.fault(),
      "reads 4 bytes at shared address 0x40: 0 bytes past the end of the block's shared memory (64 bytes)"));
}

TEST_CASE("the numbers of blocks and threads begin where the launch says, and those within a block at 0") {
  TextLaunch launch(R"(
    ld.param.b64 %rd12, [0];
    mov.b32 %r4, %ctaid.x;
    sub.u32 %r5, %r4, 5;
    mad.wide.u32 %rd12, %r5, 16, %rd12;
    st.global.b32 [%rd12], %r4;
    mov.b32 %r6, %ctaid.y;
    st.global.b32 [%rd12+4], %r6;
    mov.b32 %r7, %launch.x;
    mov.b32 %r8, %tid.x;
    sub.u32 %r7, %r7, %r8;
    st.global.b32 [%rd12+8], %r7;
    mov.b32 %r9, %nctaid.x;
    st.global.b32 [%rd12+12], %r9;
    exit;
)",
                    {.grid = {2, 1, 1}, .block = {32, 1, 1}});
  set_first_block(launch.world, {5, 7, 0});
  launch.run();
  CHECK(launch.words(0, 8) == std::vector<uint32_t>{5, 7, 160, 2, 6, 7, 192, 2});
}

}  // namespace glint::exec
