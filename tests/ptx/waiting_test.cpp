// Tests lanes that wait in a loop for other lanes of their warp: spin locks, and flags behind fences.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <fmt/format.h>
#include <numeric>
#include <string>
#include <vector>

#include "tests/ptx/one_warp.h"
#include "tests/support/catch.h"

using namespace glint;

namespace {

// Returns a kernel `k` of a lock and of words. The body has them in %lock and %words, and the thread in %t.
std::string with_lock(const std::string& body) {
  return kHead +
         ".visible .entry k(.param .u64 lock, .param .u64 words)\n{\n.reg .b32 %t, %r<40>; .reg .b64 %lock, "
         "%words, "
         "%rd<9>; .reg .pred %p<9>; .shared .align 8 .b8 sh[64];\n"
         "ld.param.u64 %lock, [lock]; ld.param.u64 %words, [words]; mov.u32 %t, %tid.x; mov.u32 %r30, "
         "%ctaid.x; "
         "mov.u32 %r31, %ntid.x; mad.lo.u32 %t, %r30, %r31, %t;\n" +
         body + "\nret;\n}\n";
}

// Runs such a kernel on one of the machines and returns the words.
std::vector<uint32_t> ran(const std::string& body, uint32_t blocks, uint32_t threads, bool timing) {
  Launcher k(with_lock(body), "test.ptx", "k");
  k.buffer(std::vector<uint32_t>(4)).buffer(std::vector<uint32_t>(blocks * threads));
  const pipeline::KernelGrid grid{{blocks, 1, 1}, {threads, 1, 1}, 0};
  pipeline::GpuParams params;
  params.cores = 2;
  if (timing)
    k.run_timing(grid, params);
  else
    k.run_functional(grid);
  return k.read<uint32_t>(1, blocks * threads);
}

// Adds 1 to the first word while nobody else may, in a region behind the loop that asks for the lock.
const std::string kCount =
    "ld.volatile.global.u32 %r2, [%words]; add.u32 %r2, %r2, 1; st.volatile.global.u32 [%words], %r2; "
    "membar.gl;\n";

}  // namespace

TEST_CASE("every lane of a warp gets a lock that the lanes ask for in a loop before they count") {
  for (const bool timing : {false, true})
    for (const std::string& ask : {std::string("atom.global.cas.b32 %r1, [%lock], 0, 1;"),
                                   std::string("atom.global.exch.b32 %r1, [%lock], 1;")}) {
      CAPTURE(timing, ask);
      const std::string body = "SPIN: " + ask + " setp.ne.s32 %p1, %r1, 0; @%p1 bra SPIN;\nmembar.gl;\n" +
                               kCount + "atom.global.exch.b32 %r3, [%lock], 0;";
      CHECK(ran(body, 1, 32, timing)[0] == 32);
      CHECK(ran(body, 2, 96, timing)[0] == 192);
    }
}

TEST_CASE("lanes get a lock in a branch and in a loop of their own, and meet the others behind them") {
  // Lanes of odd number ask in turn t for the lock, each as often as its number modulo 4 says. Then all meet.
  const std::string body =
      "mov.u32 %r5, 0; and.b32 %r6, %t, 1; setp.eq.u32 %p2, %r6, 0; @%p2 bra MEET; and.b32 %r7, %t, "
      "3;\nTURN:\n"
      "SPIN: atom.global.cas.b32 %r1, [%lock], 0, 1; setp.ne.s32 %p1, %r1, 0; @%p1 bra SPIN;\nmembar.gl;\n" +
      kCount +
      "atom.global.exch.b32 %r3, [%lock], 0; add.u32 %r5, %r5, 1; setp.lt.u32 %p3, %r5, %r7; @%p3 bra TURN;\n"
      "MEET: setp.eq.u32 %p4, %t, 0; @%p4 bra END; mul.wide.u32 %rd1, %t, 4; add.u64 %rd1, %words, %rd1; "
      "st.global.u32 [%rd1], %r5;\nEND:";
  for (const bool timing : {false, true}) {
    CAPTURE(timing);
    std::vector<uint32_t> wanted(64);
    for (uint32_t t = 1; t < 64; ++t) wanted[t] = t % 2 ? t % 4 : 0;
    wanted[0] = std::accumulate(wanted.begin(), wanted.end(), 0u);
    CHECK(ran(body, 1, 64, timing) == wanted);
  }
}

TEST_CASE("lanes wait for a flag that a lane of the same warp sets on the other path") {
  // Either side of the branch waits for lane 5, whichever runs first.
  for (const bool timing : {false, true})
    for (const bool sets_first : {false, true})
      for (const std::string& look : {std::string("ld.acquire.gpu.global.u32 %r1, [%lock];"),
                                      std::string("ld.relaxed.sys.global.u32 %r1, [%lock];"),
                                      std::string("ld.volatile.global.u32 %r1, [%lock];"),
                                      std::string("nanosleep.u32 100; ld.global.u32 %r1, [%lock];")}) {
        CAPTURE(timing, sets_first, look);
        const std::string wait = "WAIT: " + look + " setp.eq.u32 %p1, %r1, 0; @%p1 bra WAIT;\n";
        const std::string set = "mov.u32 %r1, 7; st.release.gpu.global.u32 [%lock], %r1;\n";
        const std::string body =
            fmt::format("setp.{}.u32 %p2, %t, 5; @%p2 bra ELSE;\n", sets_first ? "ne" : "eq") +
            (sets_first ? set : wait) + "bra MEET;\nELSE:\n" + (sets_first ? wait : set) +
            "MEET: mul.wide.u32 %rd1, %t, 4; add.u64 %rd1, %words, %rd1; st.global.u32 [%rd1], %r1;";
        CHECK(ran(body, 1, 32, timing) == std::vector<uint32_t>(32, 7));
      }
}

TEST_CASE("loads that others may change cost nothing more outside of loops") {
  Launcher plain(with_lock("ld.global.u32 %r1, [%lock];"), "test.ptx", "k"),
      strong(with_lock("ld.volatile.global.u32 %r1, [%lock]; nanosleep.u32 7;"), "test.ptx", "k");
  CHECK(plain.world().world.image->code.size() == strong.world().world.image->code.size());
}

TEST_CASE("lanes wait for a barrier in shared memory at which lanes of the same warp arrive") {
  const std::string body =
      "setp.eq.u32 %p1, %t, 0; @%p1 mbarrier.init.shared.b64 [sh], 16; bar.sync 0; setp.lt.u32 %p2, %t, 16; "
      "@!%p2 bra ARRIVE;\nWAIT: mbarrier.test_wait.parity.shared.b64 %p3, [sh], 0; @!%p3 bra WAIT;\nbra "
      "MEET;\n"
      "ARRIVE: mbarrier.arrive.shared.b64 %rd2, [sh];\nMEET: mul.wide.u32 %rd1, %t, 4; add.u64 %rd1, %words, "
      "%rd1; "
      "mov.u32 %r1, 3; st.global.u32 [%rd1], %r1;";
  for (const bool timing : {false, true}) {
    CAPTURE(timing);
    CHECK(ran(body, 1, 32, timing) == std::vector<uint32_t>(32, 3));
  }
}

TEST_CASE("lanes take tickets, and look for theirs by adding nothing") {
  const std::string body =
      "atom.global.add.u32 %r5, [%lock], 1;\nWAIT: atom.global.add.u32 %r1, [%lock+4], 0; setp.ne.u32 %p1, "
      "%r1, %r5; "
      "@%p1 bra WAIT;\nmembar.gl;\n" +
      kCount + "atom.global.add.u32 %r3, [%lock+4], 1;";
  for (const bool timing : {false, true}) {
    CAPTURE(timing);
    CHECK(ran(body, 2, 64, timing)[0] == 128);
  }
}

TEST_CASE("lanes that had to go on before others meet these at a barrier, a shuffle and a reduction") {
  // Lane t waits for its turn; the last lane of a warp is the first. Then all lanes of the block come
  // together.
  const std::string turn =
      "mov.u32 %r5, %tid.x; sub.u32 %r6, %ntid.x, %r5; sub.u32 %r6, %r6, 1;\n"
      "WAIT: ld.volatile.global.u32 %r1, [%lock]; setp.ne.u32 %p1, %r1, %r6; @%p1 bra WAIT;\nmembar.gl; "
      "add.u32 %r1, %r1, 1; st.volatile.global.u32 [%lock], %r1; membar.gl;\n";
  const std::string end = "mul.wide.u32 %rd1, %t, 4; add.u64 %rd1, %words, %rd1; st.global.u32 [%rd1], %r9;";
  const auto all = [](uint32_t word) { return std::vector<uint32_t>(64, word); };
  for (const bool timing : {false, true}) {
    CAPTURE(timing);
    CHECK(ran(turn + "bar.sync 0; ld.global.u32 %r9, [%lock];" + end, 1, 64, timing) == all(64));
    CHECK(ran(turn + "setp.gt.u32 %p2, %t, 2; barrier.red.popc.u32 %r9, 0, %p2;" + end, 1, 64, timing) ==
          all(61));
    CHECK(ran(turn + "vote.sync.ballot.b32 %r9, 1, 0xffffffff;" + end, 1, 64, timing) == all(~0u));
    CHECK(ran(turn + "redux.sync.add.u32 %r9, 3, 0xffffffff;" + end, 1, 64, timing) == all(96));
    CHECK(ran(turn + "bar.warp.sync 0xffffffff; activemask.b32 %r9;" + end, 1, 64, timing) == all(~0u));
    // Only the lanes of the mask have to come.
    CHECK(ran("and.b32 %r10, %t, 31; setp.lt.u32 %p3, %r10, 8; mov.u32 %r9, 0; @!%p3 bra END;\n" + turn +
                  "redux.sync.add.u32 %r9, 3, 0xff;\nEND:" + end,
              1, 8, timing) == std::vector<uint32_t>(8, 24));
  }
}

TEST_CASE("threads of a block wait at its barrier while one of them waits for the block before") {
  const std::string body =
      "mov.u32 %r5, %tid.x; setp.ne.u32 %p2, %r5, 0; @%p2 bra MEET;\nmov.u32 %r6, %ctaid.x;\n"
      "WAIT: ld.volatile.global.u32 %r1, [%lock]; setp.ne.u32 %p1, %r1, %r6; @%p1 bra WAIT;\nMEET: bar.sync "
      "0;\n"
      "ld.volatile.global.u32 %r9, [%lock]; bar.sync 0; add.u32 %r7, %r9, 1; @!%p2 st.volatile.global.u32 "
      "[%lock], "
      "%r7;\nmul.wide.u32 %rd1, %t, 4; add.u64 %rd1, %words, %rd1; st.global.u32 [%rd1], %r9;";
  for (const bool timing : {false, true}) {
    CAPTURE(timing);
    std::vector<uint32_t> wanted;
    for (uint32_t block = 0; block < 6; ++block) wanted.insert(wanted.end(), 64, block);
    CHECK(ran(body, 6, 64, timing) == wanted);
  }
}

TEST_CASE("lanes of a long loop that add or store meet the others behind it") {
  // 300 turns are more than a warp gives to a loop in which nothing happens. %r5 is how many lanes meet.
  for (const std::string& effect :
       {std::string("red.global.add.u32 [%lock], 1;"), std::string("st.global.u32 [%lock], %r4;")}) {
    CAPTURE(effect);
    const std::string body =
        "mov.u32 %r4, 0; setp.lt.u32 %p2, %t, 7; @%p2 bra MEET;\nTURN: " + effect +
        " membar.gl; add.u32 %r4, %r4, 1; setp.lt.u32 %p1, %r4, 300; @%p1 bra TURN;\n"
        "MEET: activemask.b32 %r5; mul.wide.u32 %rd1, %t, 4; add.u64 %rd1, %words, %rd1; "
        "st.global.u32 [%rd1], %r5;";
    CHECK(ran(body, 1, 32, false) == std::vector<uint32_t>(32, ~0u));
  }
}
