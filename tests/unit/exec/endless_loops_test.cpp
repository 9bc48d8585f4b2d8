// Tests which instructions belong to loops that nothing leads out of, and what messages say of loops.
// SPDX-License-Identifier: Apache-2.0
#include "exec/endless_loops.h"

#include "tests/support/catch.h"
#include "tests/unit/exec/text_launch.h"

namespace glint::exec {
namespace {

using Catch::Contains;

// Returns the instructions that belong to endless loops.
std::vector<uint32_t> endless_of(const std::string& code) {
  const TextLaunch launch(code, {});
  const EndlessLoops loops(launch.image);
  std::vector<uint32_t> out;
  for (uint32_t pc = 0; pc < launch.image.code.size(); ++pc)
    if (loops.holds(pc)) out.push_back(pc);
  CHECK(loops.any() == !out.empty());
  return out;
}

const std::string kHead = "    mov.b32 %r1, 0;\n    setp.eq.u32 %p1, %r1, 0;\n";  // instructions 0 and 1

TEST_CASE("a loop with an exit, a return or a trap in it is no endless one") {
  const std::string begin = kHead + "again:\n    add.u32 %r1, %r1, 1;\n", again = "    bra again;\n";
  CHECK(endless_of(begin + "    @%p1 bra out;\n" + again + "out:\n    exit;\n") == std::vector<uint32_t>{});
  CHECK(endless_of(begin + "    @%p1 exit;\n" + again) == std::vector<uint32_t>{});
  CHECK(endless_of(begin + "    @%p1 trap;\n" + again) == std::vector<uint32_t>{});
  CHECK(endless_of("    exit;\n") == std::vector<uint32_t>{});
}

TEST_CASE("a loop without a way out is endless, and what leads to it is not part of it") {
  CHECK(endless_of(kHead + "again:\n    add.u32 %r1, %r1, 1;\n    bra again;\n") ==
        std::vector<uint32_t>{2, 3});
  CHECK(endless_of(kHead + "    @%p1 bra out;\nagain:\n    bra again;\nout:\n    exit;\n") ==
        std::vector<uint32_t>{3});
}

TEST_CASE("of two loops in each other the outer one is named when both are endless") {
  TextLaunch launch(
      "outer:\n    mov.b32 %r1, 0;\ninner:\n    add.u32 %r1, %r1, 1;\n    setp.lt.u32 %p1, %r1, 9;\n"
      "    @%p1 bra inner;\n    bra outer;\n",
      {});
  CHECK_THAT(launch.fault(),
             Contains("nothing leads out of the loop of instructions 0 to 4, which the warp has entered"));
  CHECK(loops_around(launch.image, 2) ==
        "in the loop of instructions 1 to 3, which is in the loop of instructions 0 to 4");
  CHECK(loops_around(launch.image, 0) == "in the loop of instructions 0 to 4");
}

TEST_CASE("a function that returns does not end the loop that calls it, and one that exits does") {
  const std::string caller = "again:\n    call f;\n    bra again;\nf:\n";
  CHECK(endless_of(caller + "    ret;\n") == std::vector<uint32_t>{0, 1});
  CHECK(endless_of(caller + kHead + "    @%p1 exit;\n    ret;\n") == std::vector<uint32_t>{});
}

}  // namespace
}  // namespace glint::exec
