// Tests where lanes meet again in loops whose turns have several ways through and several ways out.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <fmt/format.h>

#include "tests/ptx/launcher.h"
#include "tests/support/catch.h"

using namespace glint;

namespace {

constexpr uint32_t kTurns = 8;

// Returns a kernel of one warp that stores %out of each lane. At AGAIN, %out counts the turns, among the
// first eight, in which some lanes are missing at the loop's head.
std::string loop(const std::string& turn, const std::string& before = "") {
  return ".version 7.0\n.target sm_70\n.address_size 64\n.visible .entry k(.param .u64 to)\n{\n"
         ".reg .b32 %out, %lane, %turn, %here, %bit, %limit; .reg .b64 %at; .reg .pred %p<9>;\n"
         "mov.u32 %lane, %tid.x; mov.u32 %out, 0; mov.u32 %turn, 0; and.b32 %limit, %lane, 3;\n" +
         before + "AGAIN:\nactivemask.b32 %here; setp.ne.u32 %p0, %here, -1; setp.lt.and.u32 %p1, %turn, " +
         std::to_string(kTurns) +
         ", %p0;\n"
         "@%p1 add.u32 %out, %out, 1;\nadd.u32 %turn, %turn, 1; add.u32 %bit, %lane, %turn; and.b32 %bit, "
         "%bit, 1; setp.eq.u32 %p2, %bit, 0;\n" +
         turn +
         "END:\nactivemask.b32 %here; setp.ne.u32 %p0, %here, -1; @%p0 add.u32 %out, %out, 1000;\n"
         "ld.param.u64 %at, [to]; mad.wide.u32 %at, %lane, 4, %at; st.global.u32 [%at], %out; ret;\n}\n";
}

std::vector<uint32_t> partings(const std::string& text) {
  Launcher k(text, "loop.ptx", "k");
  k.buffer(std::vector<uint32_t>(32));
  k.run_functional({{1, 1, 1}, {32, 1, 1}, 0});
  return k.read<uint32_t>(0, 32);
}

const std::vector<uint32_t> kNone(32);

}  // namespace

TEST_CASE(
    "lanes that go on to a loop's next turn by one way wait for those that come by another, past the way "
    "out") {
  // Lanes with an even sum of lane and turn go round at once; the others may leave first.
  const std::string text = loop(fmt::format(
      "@%p2 bra AGAIN;\nxor.b32 %bit, %bit, 3;\nsetp.gt.u32 %p3, %turn, {}; @%p3 bra END;\nbra AGAIN;\n",
      kTurns));

  CHECK(partings(text) == kNone);
}

TEST_CASE("lanes wait at the end of a turn for those in a loop within it") {
  const std::string text =
      loop(fmt::format("@%p2 bra AGAIN;\nmov.u32 %bit, 0;\nINNER: add.u32 %bit, %bit, 1; setp.lt.u32 %p4, "
                       "%bit, %limit; @%p4 bra INNER;\n"
                       "setp.gt.u32 %p3, %turn, {}; @%p3 bra END;\nbra AGAIN;\n",
                       kTurns));

  CHECK(partings(text) == kNone);
}

TEST_CASE(
    "lanes that leave two loops at once meet the others behind both, also when the outer loop runs again") {
  // The inner loop's second exit leaves both loops. The outer loop makes four turns for the other lanes.
  const std::string text =
      loop(fmt::format("@%p2 bra AGAIN;\nsetp.eq.u32 %p5, %turn, 14; @%p5 bra END;\nsetp.gt.u32 %p3, %turn, "
                       "{}; @%p3 bra OUTER;\nbra AGAIN;\n"
                       "OUTER: add.u32 %limit, %limit, 1; setp.lt.u32 %p6, %limit, 7; @%p6 bra START;\n",
                       kTurns),
           "START:\n");

  CHECK(partings(text) == kNone);
}
