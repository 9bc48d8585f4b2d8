// Tests asynchronous copies and barriers in shared memory: what kernels compute on both machines, how long
// they wait, and which forms are refused.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <string>
#include <utility>
#include <vector>

#include "core/async_copies.h"
#include "tests/ptx/one_warp.h"
#include "tests/support/catch.h"

using namespace glint;

namespace {

// Returns a kernel `k` of a buffer for results, one for data, and 4 KB of shared memory. The body leaves a
// word in %out for each thread %t.
std::string with_shared(const std::string& body) {
  return kHead +
         ".visible .entry k(.param .u64 to, .param .u64 from)\n{\n.reg .b32 %out, %t, %lane, %warp, %r<40>; "
         ".reg .b64 "
         "%to, %from, %rd<40>; .reg .pred %p<20>;\n.shared .align 16 .b8 sh[4096];\n"
         "ld.param.u64 %to, [to]; ld.param.u64 %from, [from]; mov.u32 %t, %tid.x; and.b32 %lane, %t, 31; "
         "shr.u32 "
         "%warp, %t, 5; mov.u32 %out, 0;\n" +
         body +
         "\nmul.wide.u32 %rd39, %t, 4; add.u64 %rd39, %to, %rd39; st.global.u32 [%rd39], %out; ret;\n}\n";
}

pipeline::GpuParams small_gpu() {
  pipeline::GpuParams params;
  params.cores = 2;
  return params;
}

// Runs such a kernel over one block, with the word i * 7 + 1 at place i of the data.
std::vector<uint32_t> ran(const std::string& body, uint32_t threads, bool timing,
                          const pipeline::GpuParams& params = small_gpu()) {
  Launcher k(with_shared(body), "test.ptx", "k");
  std::vector<uint32_t> data(4096);
  for (uint32_t i = 0; i < data.size(); ++i) data[i] = i * 7 + 1;
  k.buffer(std::vector<uint32_t>(threads)).buffer(data);
  const pipeline::KernelGrid grid{{1, 1, 1}, {threads, 1, 1}, 0};
  if (timing)
    k.run_timing(grid, params);
  else
    k.run_functional(grid);
  return k.read<uint32_t>(0, threads);
}

uint32_t datum(uint32_t i) {
  return i * 7 + 1;
}

std::string refusal(const std::string& line) {
  return message_of(with_shared(line));
}

// Warp 0 copies tiles of 32 words into four places, and warp 1 sums them up. Barriers say which places are
// full and which are free.
constexpr const char* kStages = R"(
    setp.ne.u32 %p1, %t, 0;
    @%p1 bra READY;
    mbarrier.init.shared.b64 [sh+1024], 32; mbarrier.init.shared.b64 [sh+1032], 32;
    mbarrier.init.shared.b64 [sh+1040], 32; mbarrier.init.shared.b64 [sh+1048], 32;
    mbarrier.init.shared.b64 [sh+1056], 32; mbarrier.init.shared.b64 [sh+1064], 32;
    mbarrier.init.shared.b64 [sh+1072], 32; mbarrier.init.shared.b64 [sh+1080], 32;
  READY: bar.sync 0;
    mov.u32 %r1, 0;
    setp.eq.u32 %p2, %warp, 1;
    mov.u32 %r9, sh;
  TILE: and.b32 %r2, %r1, 3; shr.u32 %r3, %r1, 2; and.b32 %r3, %r3, 1; xor.b32 %r4, %r3, 1;
    mad.lo.u32 %r5, %r2, 8, %r9; mad.lo.u32 %r6, %r2, 128, %r9;
    @%p2 bra CONSUME;
  FREE: mbarrier.try_wait.parity.shared.b64 %p3, [%r5+1056], %r4;
    @!%p3 bra FREE;
    mad.lo.u32 %r7, %r1, 32, %lane; mul.wide.u32 %rd1, %r7, 4; add.u64 %rd1, %from, %rd1;
    mad.lo.u32 %r6, %lane, 4, %r6;
    cp.async.ca.shared.global [%r6], [%rd1], 4;
    cp.async.mbarrier.arrive.noinc.shared.b64 [%r5+1024];
    bra NEXT;
  CONSUME: mbarrier.try_wait.parity.shared.b64 %p3, [%r5+1024], %r3;
    @!%p3 bra CONSUME;
    xor.b32 %r7, %lane, 5; mad.lo.u32 %r6, %r7, 4, %r6; ld.shared.u32 %r8, [%r6];
    mad.lo.u32 %out, %out, 3, %r8;
    mbarrier.arrive.shared.b64 _, [%r5+1056];
  NEXT: add.u32 %r1, %r1, 1; setp.lt.u32 %p4, %r1, 20; @%p4 bra TILE;)";

// Warp 1 waits for an arrival of warp 0 that comes after `cycles`. It leaves how often it asked, and how many
// cycles after the arrival it went on.
std::string late_arrival(int cycles) {
  return fmt::format(R"(
    setp.ne.u32 %p1, %t, 0;
    @!%p1 mbarrier.init.shared.b64 [sh], 1;
    bar.sync 0;
    setp.eq.u32 %p2, %warp, 1;
    @%p2 bra WAIT;
    @%p1 bra MEET;
    mov.u32 %r1, %clock;
  SPIN: mov.u32 %r2, %clock; sub.u32 %r3, %r2, %r1; setp.lt.u32 %p3, %r3, {};
    @%p3 bra SPIN;
    mov.u32 %r4, %clock; st.shared.u32 [sh+8], %r4;
    mbarrier.arrive.shared.b64 _, [sh];
    bra MEET;
  WAIT: add.u32 %r5, %r5, 1;
    mbarrier.try_wait.parity.shared.b64 %p4, [sh], 0;
    @!%p4 bra WAIT;
    mov.u32 %r6, %clock;
  MEET: bar.sync 0;
    ld.shared.u32 %r7, [sh+8]; sub.u32 %r6, %r6, %r7;
    setp.eq.u32 %p5, %lane, 0; selp.u32 %out, %r5, %r6, %p5;)",
                     cycles);
}

}  // namespace

TEST_CASE("copies of 4, 8 and 16 bytes take what they are told from global memory, and zeros") {
  const std::string body = R"(
    mul.lo.u32 %r1, %lane, 64; mov.u32 %r2, sh; add.u32 %r1, %r1, %r2;
    mul.wide.u32 %rd1, %lane, 16; add.u64 %rd1, %from, %rd1;
    st.shared.u32 [%r1+4], 0;
    cp.async.ca.shared.global [%r1], [%rd1+4], 4;
    cp.async.ca.shared::cta.global.L2::128B [%r1+8], [%rd1+8], 8;
    cp.async.cg.shared.global [%r1+16], [%rd1+32], 16;
    rem.u32 %r3, %lane, 17;
    cp.async.ca.shared.global [%r1+32], [%rd1], 16, %r3;
    setp.gt.u32 %p1, %lane, 20;
    mov.u64 %rd3, 16; selp.u64 %rd2, %rd3, %rd1, %p1;
    cp.async.cg.shared.global [%r1+48], [%rd2], 16, %p1;
    cp.async.commit_group; cp.async.wait_group 0;
    mov.u32 %r4, 0;
  SUM: ld.shared.u32 %r5, [%r1]; mad.lo.u32 %out, %out, 31, %r5; add.u32 %r1, %r1, 4; add.u32 %r4, %r4, 1;
    setp.lt.u32 %p2, %r4, 16; @%p2 bra SUM;)";
  std::vector<uint32_t> sums;
  for (uint32_t lane = 0; lane < 32; ++lane) {
    const uint32_t first = 4 * lane, size = lane % 17;
    std::vector<uint32_t> words{datum(first + 1), 0, datum(first + 2), datum(first + 3)};
    for (uint32_t i = 0; i < 4; ++i) words.push_back(datum(first + 8 + i));
    for (uint32_t i = 0; i < 4; ++i) {
      const uint32_t bytes = std::min(4u, size - std::min(size, 4 * i));
      words.push_back(uint32_t(datum(first + i) & ((uint64_t{1} << (8 * bytes)) - 1)));
    }
    for (uint32_t i = 0; i < 4; ++i) words.push_back(lane > 20 ? 0 : datum(first + i));
    uint32_t sum = 0;
    for (const uint32_t word : words) sum = sum * 31 + word;
    sums.push_back(sum);
  }
  CHECK(ran(body, 32, false) == sums);
  CHECK(ran(body, 32, true) == sums);
}

TEST_CASE("warps hand tiles to each other through barriers that copies arrive at") {
  std::vector<uint32_t> sums(64);
  for (uint32_t lane = 0; lane < 32; ++lane)
    for (uint32_t tile = 0; tile < 20; ++tile)
      sums[32 + lane] = sums[32 + lane] * 3 + datum(tile * 32 + (lane ^ 5));
  CHECK(ran(kStages, 64, false) == sums);
  CHECK(ran(kStages, 64, true) == sums);
}

TEST_CASE("what an arrival returns tells its phase and how many arrivals were missing before it") {
  const std::string body = R"(
    setp.ne.u32 %p1, %t, 0;
    @%p1 bra END;
    mbarrier.init.shared.b64 [sh], 5;
    mbarrier.arrive.shared.b64 %rd1, [sh];
    mbarrier.arrive.noComplete.shared.b64 %rd2, [sh], 2;
    mbarrier.arrive_drop.shared.b64 %rd3, [sh];
    mbarrier.test_wait.shared.b64 %p2, [sh], %rd1;
    mbarrier.arrive.release.cta.shared::cta.b64 %rd4, [sh];
    mbarrier.test_wait.acquire.cta.shared.b64 %p3, [sh], %rd1;
    cvta.shared.u64 %rd5, 0; mov.u32 %r1, sh; cvt.u64.u32 %rd6, %r1; add.u64 %rd5, %rd5, %rd6;
    mbarrier.arrive.b64 %rd7, [%rd5];
    mbarrier.test_wait.b64 %p4, [%rd5], %rd7;
    mbarrier.pending_count.b64 %r1, %rd1; mbarrier.pending_count.b64 %r2, %rd2;
    mbarrier.pending_count.b64 %r3, %rd3; mbarrier.pending_count.b64 %r4, %rd4;
    mbarrier.pending_count.b64 %r5, %rd7;
    mad.lo.u32 %out, %r1, 10, %r2; mad.lo.u32 %out, %out, 10, %r3; mad.lo.u32 %out, %out, 10, %r4;
    mad.lo.u32 %out, %out, 10, %r5;
    selp.u32 %r6, 1, 0, %p2; mad.lo.u32 %out, %out, 10, %r6;
    selp.u32 %r6, 1, 0, %p3; mad.lo.u32 %out, %out, 10, %r6;
    selp.u32 %r6, 1, 0, %p4; mad.lo.u32 %out, %out, 10, %r6;
  END:)";
  for (const bool timing : {false, true}) CHECK(ran(body, 32, timing)[0] == 54214010u);
}

TEST_CASE("a warp that waits for a phase asks again only when it has ended or when its time is over") {
  pipeline::GpuParams params = small_gpu();
  const auto asked_and_delay = [&](int cycles) {
    const std::vector<uint32_t> words = ran(late_arrival(cycles), 64, true, params);
    return std::pair(words[32], words[33]);
  };
  params.core.async.suspension = 5000;
  const auto [asked, delay] = asked_and_delay(2000);
  CHECK(asked == 1);
  CHECK(asked_and_delay(2011) == std::pair(1u, delay));
  params.core.async.wake += 40;
  CHECK(asked_and_delay(2000) == std::pair(1u, delay + 40));
  params.core.async.suspension = 500;
  CHECK(asked_and_delay(2300).first == 5);
}

TEST_CASE("mbarrier.try_wait answers after its time that a phase has not ended") {
  const std::string body =
      "setp.eq.u32 %p1, %t, 0; @%p1 mbarrier.init.shared.b64 [sh], 40; bar.sync 0; mov.u32 %r1, %clock; "
      "mbarrier.try_wait.parity.shared.b64 %p2, [sh], 0, 100; selp.u32 %r3, 100000, 0, %p2; mov.u32 %r2, "
      "%clock; "
      "sub.u32 %out, %r2, %r1; add.u32 %out, %out, %r3;";
  pipeline::GpuParams params = small_gpu();
  params.core.async.suspension = 1000;
  const uint32_t first = ran(body, 32, true, params)[0];
  CHECK(first >= 1000);
  CHECK(first < 1040);
  params.core.async.suspension = 3500;
  CHECK(ran(body, 32, true, params)[0] == first + 2500);
}

TEST_CASE("a wait for a phase that nobody ends is an error on both machines") {
  const std::string body =
      "setp.eq.u32 %p1, %t, 0; @%p1 mbarrier.init.shared.b64 [sh], 40; bar.sync 0;\nWAIT: "
      "mbarrier.try_wait.parity.shared.b64 %p2, [sh], 0; @!%p2 bra WAIT;";
  pipeline::GpuParams params = small_gpu();
  params.core.livelock_budget = 100'000;
  CHECK_THROWS_WITH(ran(body, 32, true, params), Catch::Contains("nothing in memory has changed"));
  Launcher k(with_shared(body), "test.ptx", "k");
  k.buffer(std::vector<uint32_t>(32)).buffer(std::vector<uint32_t>(4));
  k.world().set_grid(kWarp);
  k.set_arguments();
  CHECK_THROWS_WITH(pipeline::run_functional(k.world().world, 100'000, {}),
                    Catch::Contains("no end in sight"));
}

TEST_CASE("a wait for groups lets the youngest ones be under way, and a fence waits for no copy") {
  // The first group is in the L1. %out is the time until the first group is there, or both, or of a fence.
  const auto cycles = [](const std::string& wait) {
    const std::string body =
        "mul.wide.u32 %rd1, %lane, 4; add.u64 %rd1, %from, %rd1; mad.lo.u32 %r1, %lane, 4, 0; mov.u32 %r2, "
        "sh; "
        "add.u32 %r1, %r1, %r2; ld.global.u32 %r3, [%rd1]; st.shared.u32 [%r1+512], %r3; bar.sync 0; "
        "membar.cta;\n"
        "mov.u32 %r4, %clock; cp.async.ca.shared.global [%r1], [%rd1], 4; cp.async.commit_group; "
        "cp.async.ca.shared.global [%r1+128], [%rd1+8192], 4; cp.async.commit_group;\n" +
        wait + " mov.u32 %r5, %clock; sub.u32 %out, %r5, %r4; cp.async.wait_all;";
    return ran(body, 32, true)[0];
  };
  const uint32_t none = cycles("cp.async.wait_group 2;"), first = cycles("cp.async.wait_group 1;"),
                 both = cycles("cp.async.wait_group 0;"), fence = cycles("membar.cta;");
  CAPTURE(none, first, both, fence);
  CHECK(none < first);
  CHECK(first + 100 < both);
  CHECK(cycles("cp.async.wait_all;") >= both - 1);
  CHECK(cycles("cp.async.wait_all;") <= both + 1);  // It is a commit and a wait.
  CHECK(fence < first);
}

TEST_CASE("copies are counted by group, the youngest seven groups and the open one apart") {
  core::CopyGroups groups;
  std::vector<uint32_t> numbers;
  for (int i = 0; i < 10; ++i) {
    numbers.push_back(groups.start());
    CHECK(groups.start() == numbers.back());
    groups.commit();
  }
  groups.start();
  CHECK(groups.num_before(0) == 20);  // without the copy of the open group
  CHECK(groups.num_before(1) == 18);
  CHECK(groups.num_before(6) == 8);
  CHECK(groups.num_before(7) == 6);
  CHECK(groups.num_before(9) == 6);  // The three oldest are one.
  groups.end(numbers[0]);
  groups.end(numbers[9]);
  CHECK(groups.num_before(0) == 18);
  CHECK(groups.num_before(1) == 17);
  CHECK(groups.num_before(7) == 5);
}

TEST_CASE("forms of copies and barriers are taken and refused as the assembler of an H200 does") {
  for (const char* line :
       {"cp.async.ca.shared.global [sh], [%from], 4;", "cp.async.ca.shared.global [%r1], [%from], 16, 8;",
        "cp.async.ca.shared.global [%r1], [%from], 16, !%p1;",
        "cp.async.cg.shared.global.L2::cache_hint.L2::256B [%r1], [%from], 16, %r2, %rd5;",
        "cp.async.ca.shared.global [%r1+16], [%from+32], 16;", "@%p1 cp.async.wait_all;",
        "cp.async.wait_group 100;", "mbarrier.init.b64 [%rd1], 32;",
        "mbarrier.init.shared::cta.b64 [%r1], %r2;", "mbarrier.arrive.shared.b64 _, [sh];",
        "mbarrier.arrive.release.cluster.shared::cta.b64 %rd1, [sh], %r2;",
        "mbarrier.arrive_drop.noComplete.shared.b64 %rd1, [sh], 2;",
        "mbarrier.test_wait.shared.b64 %p1, [sh], 0;",
        "mbarrier.try_wait.parity.acquire.cta.shared::cta.b64 %p1, [sh], %r1, 0x989680;",
        "cp.async.mbarrier.arrive.noinc.b64 [%rd1];", "cp.async.mbarrier.arrive.shared::cta.b64 [%r1];"}) {
    CAPTURE(line);
    CHECK(refusal(line) == "no error");
  }
  for (const char* line : {"cp.async.ca.shared.global [%r1], [%from], 16, %rd1;",
                           "cp.async.ca.shared.global [%r1], [%from], %r3;",
                           "cp.async.shared.global [%r1], [%from], 16;",
                           "cp.async.ca.global.shared [%from], [%r1];",
                           "cp.async.ca.global [%r1], [%from], 16;",
                           "cp.async.commit_group %r1;",
                           "cp.async.wait_group %r1;",
                           "cp.async.wait_group;",
                           "cp.async.wait_all 0;",
                           "mbarrier.init.shared.b32 [sh], 32;",
                           "mbarrier.init.shared.b64 [sh];",
                           "mbarrier.init.shared.b64 [sh], %rd1;",
                           "mbarrier.init.global.b64 [%rd1], 1;",
                           "mbarrier.arrive.shared.b64 [sh];",
                           "mbarrier.arrive.shared.b64 %r1, [sh];",
                           "mbarrier.arrive.acquire.cta.shared::cta.b64 %rd1, [sh];",
                           "mbarrier.arrive.noComplete.shared.b64 %rd1, [sh];",
                           "mbarrier.test_wait.acquire.shared.b64 %p1, [sh], %rd1;",
                           "mbarrier.test_wait.release.cta.shared.b64 %p1, [sh], %rd1;",
                           "mbarrier.test_wait.shared.b64 %r1, [sh], %rd1;",
                           "mbarrier.test_wait.shared.b64 %p1, [sh], %r1;",
                           "mbarrier.test_wait.shared.b64 %p1, [sh], %rd1, %r2;",
                           "mbarrier.test_wait.parity.shared.b64 %p1, [sh], %rd1;",
                           "mbarrier.pending_count.shared.b64 %r1, %rd1;",
                           "mbarrier.pending_count.b64 %rd2, %rd1;",
                           "mbarrier.frob.shared.b64 [sh];",
                           "cp.async.mbarrier.arrive.shared.b64 %rd1, [sh];"}) {
    CAPTURE(line);
    CHECK(refusal(line).find("test.ptx:9:") == 0);
  }
  const auto says = [](const char* line, const char* message) {
    CAPTURE(line);
    CHECK_THAT(refusal(line), Catch::Contains(message));
  };
  says("cp.async.cg.shared.global [%r1], [%from], 8;",
       "test.ptx:9:43: error: 'cp.async.cg.shared.global' copies 16 bytes");
  says("cp.async.ca.shared.global [%r1], [%from], 12;", "copies 4, 8 or 16 bytes");
  says("cp.async.ca.shared.global [%r1], [%from], 16, 20;",
       "takes a predicate or 0 to 16 bytes in 32 bits here");
  says("cp.async.wait_group -1;", "'cp.async.wait_group' takes a constant number of groups");
  says("mbarrier.arrive.expect_tx.shared::cta.b64 %rd1, [sh], %r1;", "belongs to bulk copies");
  says("mbarrier.arrive.shared::cluster.b64 _, [%r1];", "belongs to clusters of more than one block");
  says("cp.async.bulk.shared::cluster.global.mbarrier::complete_tx::bytes [%r1], [%from], 64, [%r2];",
       "belongs to bulk copies");
}

TEST_CASE("a copy that reaches outside of memory, or is not aligned, is a fault") {
  const auto says = [](const std::string& body, const char* message) {
    CAPTURE(body);
    for (const bool timing : {false, true})
      CHECK_THROWS_WITH(ran(body, 32, timing), Catch::Contains(message));
  };
  says("cp.async.ca.shared.global [sh], [%from+16384], 4;", "reads 4 bytes at");
  says("cp.async.ca.shared.global [sh], [%from+4], 16;", "which is not a multiple of 16");
  says("mov.u32 %r1, 4092; cp.async.ca.shared.global [%r1], [%from], 8;",
       "writes 8 bytes at shared address 0xffc: 8 bytes across the end of the block's shared memory");
  says("mov.u32 %r1, sh; add.u32 %r1, %r1, 4; cp.async.ca.shared.global [%r1], [%from], 8;",
       "writes 8 bytes at shared address 0x4, which is not a multiple of 8");
  says("mov.u32 %r1, 9; cp.async.ca.shared.global [sh], [%from], 8, %r1;",
       "copies 9 bytes of global memory to 8 bytes of shared memory");
}
