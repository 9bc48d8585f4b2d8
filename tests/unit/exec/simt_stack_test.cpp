// Tests the SIMT stack: which lanes run when, also when paths take turns.
// SPDX-License-Identifier: Apache-2.0
#include "exec/simt_stack.h"

#include <vector>

#include "tests/support/catch.h"

using namespace glint;
using exec::SimtStack;

namespace {

// Ends the running path at the join at `pc`, and takes what comes next.
void come_to(SimtStack& simt, uint32_t pc) {
  REQUIRE(simt.arrive(pc, simt.active));
  simt.active = 0;
  SimtStack::Entry call{};
  simt.resume_next(&call);
}

// Returns the entry of that path, or the number of entries if it is not there.
size_t path_at(const SimtStack& simt, uint32_t pc) {
  size_t i = 0;
  while (i < simt.depth() && !(simt.entries()[i].kind == SimtStack::Kind::Path && simt.entries()[i].pc == pc))
    ++i;
  return i;
}

void check_running(const SimtStack& simt, uint32_t pc, LaneMask lanes) {
  CHECK(simt.pc == pc);
  CHECK(simt.active == lanes);
}

// Starts four lanes, which split at once: lanes 0 and 1 run, lanes 2 and 3 wait at 20. They meet at 30.
SimtStack split() {
  SimtStack simt;
  simt.start(1, 0xf);
  simt.push_reconvergence(30);
  simt.push_path(20, 0xc);
  simt.active = 0x3;
  return simt;
}

}  // namespace

TEST_CASE("paths run one after another and meet") {
  SimtStack simt = split();
  come_to(simt, 30);
  check_running(simt, 20, 0xc);
  come_to(simt, 30);
  check_running(simt, 31, 0xf);
  CHECK(simt.depth() == 0);
  CHECK_FALSE(simt.has_switched());
}

TEST_CASE("two paths that take turns go on where they were, and meet when both have come") {
  SimtStack simt = split();
  for (int turn = 0; turn < 100; ++turn) {
    simt.pc = 5;
    simt.switch_to(path_at(simt, 20));
    check_running(simt, 20, 0xc);
    CHECK(simt.live() == 0xf);
    simt.switch_to(path_at(simt, 5));
    check_running(simt, 5, 0x3);
    REQUIRE(simt.depth() <= 3);
  }
  CHECK(simt.has_switched());
  come_to(simt, 30);
  check_running(simt, 20, 0xc);
  come_to(simt, 30);
  check_running(simt, 31, 0xf);
  CHECK(simt.depth() == 0);
}

TEST_CASE("a join inside of a path is left when its own lanes have come, whatever waits outside") {
  SimtStack simt = split();
  simt.push_reconvergence(12);  // lanes 0 and 1 split once more
  simt.push_path(10, 0x2);
  simt.active = 0x1;
  simt.pc = 8;
  simt.switch_to(path_at(simt, 20));
  check_running(simt, 20, 0xc);
  simt.push_reconvergence(28);  // and so do lanes 2 and 3, at another place
  simt.push_path(24, 0x8);
  simt.active = 0x4;
  simt.pc = 22;
  simt.switch_to(path_at(simt, 8));
  come_to(simt, 12);  // Lane 0 has come; lane 1 or one of the others runs.
  REQUIRE(simt.active != 0x1);
  if (simt.active != 0x2) simt.switch_to(path_at(simt, 10));
  check_running(simt, 10, 0x2);
  come_to(simt, 12);
  check_running(simt, 13, 0x3);
  come_to(simt, 30);
  LaneMask seen = 0;
  for (int path = 0; path < 2; ++path) {  // Either may come first.
    seen |= simt.active;
    check_running(simt, simt.active == 0x4 ? 22 : 24, simt.active);
    come_to(simt, 28);
  }
  CHECK(seen == 0xc);
  check_running(simt, 29, 0xc);
  come_to(simt, 30);
  check_running(simt, 31, 0xf);
  CHECK(simt.depth() == 0);
}

TEST_CASE("lanes that wait at a join may go on before the others, and end or meet them further out") {
  SimtStack simt;
  simt.start(1, 0xf);
  simt.push_reconvergence(40);
  simt.push_reconvergence(30);
  REQUIRE(simt.arrive(30, 0x1));
  simt.active = 0xe;
  simt.pc = 5;
  simt.switch_to(1);  // the inner join
  check_running(simt, 31, 0x1);
  come_to(simt, 40);
  check_running(simt, 5, 0xe);
  come_to(simt, 30);
  check_running(simt, 31, 0xe);
  come_to(simt, 40);
  check_running(simt, 41, 0xf);
  CHECK(simt.depth() == 0);
}

TEST_CASE("paths that wait at an instruction go on as one when the last of them has come") {
  SimtStack simt = split();  // lanes 0 and 1 run, 2 and 3 wait at 20
  simt.pc = 7;
  simt.yield_to(path_at(simt, 20));
  CHECK(simt.has_yielded());
  simt.pc = 25;
  simt.wait_for(path_at(simt, 7));
  check_running(simt, 7, 0x3);
  CHECK_FALSE(simt.can_run(path_at(simt, 25)));
  simt.take_waiting(false);
  check_running(simt, 7, 0x3);  // They wait elsewhere.
  simt.pc = 25;
  simt.take_waiting(false);
  check_running(simt, 25, 0xf);
  come_to(simt, 30);
  check_running(simt, 31, 0xf);
  CHECK(simt.depth() == 0);
}

TEST_CASE("lanes that wait inside of another join are taken where all may come together") {
  SimtStack simt = split();
  simt.push_reconvergence(28);  // around lanes 0 and 1 alone
  simt.pc = 25;
  simt.wait_for(path_at(simt, 20));
  simt.pc = 25;
  simt.take_waiting(false);
  check_running(simt, 25, 0xc);
  simt.take_waiting(true);
  check_running(simt, 25, 0xf);
  come_to(simt, 30);
  check_running(simt, 31, 0xf);
  CHECK(simt.depth() == 0);
}

TEST_CASE("paths of a caller are in another frame than those of a callee") {
  SimtStack simt = split();
  simt.push_call(7, 0, 0, 0);
  simt.pc = 100;
  simt.push_path(200, 0x2);
  simt.active = 0x1;
  CHECK_FALSE(simt.is_in_frame(path_at(simt, 20)));
  CHECK(simt.is_in_frame(path_at(simt, 200)));
  simt.switch_to(path_at(simt, 200));
  check_running(simt, 200, 0x2);
  REQUIRE(simt.arrive_return(0x2));
  simt.active = 0;
  SimtStack::Entry call{};
  CHECK_FALSE(simt.resume_next(&call));
  check_running(simt, 100, 0x1);
  REQUIRE(simt.arrive_return(0x1));
  simt.active = 0;
  CHECK(simt.resume_next(&call));
  check_running(simt, 7, 0x3);
  CHECK(simt.is_in_frame(path_at(simt, 20)));
}
