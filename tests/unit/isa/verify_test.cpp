// Tests the verifier: each kind of mistake is reported once, at its instruction, and sound programs pass.
// SPDX-License-Identifier: Apache-2.0
#include "isa/verify.h"

#include <fmt/format.h>

#include "isa/op_row.h"
#include "isa/text.h"
#include "tests/support/catch.h"

using namespace glint;
using namespace glint::isa;

namespace {

constexpr const char* kSound = R"(.program "sound"
.registers 8
.file 0 "a.comp"
.loc 0 3
    mov.b64 %rd2, 7;
    setp.eq.u32 %p1, %laneid, 3;
    ssy M;
@%p1 bra M;
    add.u32 %r1, %laneid, 5;
    add.u64 %rd6, %rd2, 5;
M:  join;
    exit;
)";

std::vector<std::string> messages_of(const Program& p) {
  Diagnostics d;
  verify(p, d);
  return d.messages();
}

// Returns the only message after `change` was applied to the sound program.
template <class Change>
std::string complaint(Change change) {
  Program p = parse(kSound, "sound");
  change(p);
  const auto messages = messages_of(p);
  return messages.size() == 1 ? messages[0] : std::to_string(messages.size()) + " messages";
}

}  // namespace

TEST_CASE("a sound program is accepted") {
  CHECK(messages_of(parse(kSound, "sound")).empty());
}

TEST_CASE("operands out of range or of the wrong bank are named with their instruction and line") {
  using Catch::Contains;
  CHECK_THAT(complaint([](Program& p) { p.code[4].operand[0] = 8; }),
             Contains("a.comp:3") &&
                 Contains("instruction 4 (add.u32), operand 1: there is no register %r8: the program has 8"));
  CHECK_THAT(complaint([](Program& p) { p.code[5].operand[1] = 3; }),
             Contains("pair %rd3 starts at an odd register"));
  CHECK_THAT(complaint([](Program& p) { p.code[4].operand[0] = kConstantBank; }),
             Contains("a constant cannot be a destination"));
  CHECK_THAT(complaint([](Program& p) { p.code[4].operand[0] = kSpecialBank; }),
             Contains("a special cannot be a destination"));
  CHECK_THAT(complaint([](Program& p) { p.code[5].operand[1] = kSpecialBank; }),
             Contains("a special cannot be a 64-bit operand"));
  CHECK_THAT(complaint([](Program& p) { p.code[4].operand[2] = kConstantBank + 6; }),
             Contains("there is no constant row 6: the program has 6"));
  CHECK_THAT(complaint([](Program& p) { p.code[5].operand[2] = kConstantBank + 5; }),
             Contains("there is no constant row 6: the program has 6"));
  CHECK_THAT(complaint([](Program& p) { p.code[4].operand[1] = Slot(kSpecialBank + kNumSpecials); }),
             Contains(fmt::format("there is no special {0}: there are {0}", kNumSpecials)));
  CHECK_THAT(complaint([](Program& p) { p.code[4].operand[1] = 0xc000; }), Contains("names no bank"));
  CHECK_THAT(complaint([](Program& p) { p.code[4].operand[5] = 1; }), Contains("operand slot 5 is set"));
  CHECK_THAT(complaint([](Program& p) { p.code[4].imm = 1; }), Contains("neither address nor label"));
  CHECK_THAT(complaint([](Program& p) { p.code[3].guard = 9; }), Contains("guard %p9"));
  CHECK_THAT(complaint([](Program& p) { p.code[4].op = 9999; }), Contains("op 9999 is not in the table"));
  CHECK_THAT(complaint([](Program& p) {
               p.code[4] = {};
               p.code[4].op = op_index("not.pred");
               p.code[4].operand = {8, 1};
             }),
             Contains("predicate %p8"));
}

TEST_CASE("control flow that leaves the code or meets at no join is refused") {
  using Catch::Contains;
  CHECK_THAT(complaint([](Program& p) { p.code[3].imm = 8; }),
             Contains("target 8 lies outside the code (0 to 7)"));
  CHECK_THAT(complaint([](Program& p) { p.code[3].imm = -1; }), Contains("target -1 lies outside"));
  CHECK_THAT(complaint([](Program& p) { p.code[2].imm = 5; }),
             Contains("instruction 5, where the lanes should meet, is not a join"));
  CHECK_THAT(complaint([](Program& p) { p.code.pop_back(), p.lines.pop_back(); }),
             Contains("instruction 6 (join): the code can run off its end"));
  CHECK_THAT(complaint([](Program& p) { p.code[7].guard = 1; }),
             Contains("instruction 7 (exit): the code can run off its end"));
  CHECK_THAT(messages_of(Program{}).at(0), Contains("no instructions"));
}

TEST_CASE("headers that contradict the code are refused") {
  using Catch::Contains;
  CHECK_THAT(complaint([](Program& p) { p.num_registers = 256; }),
             Contains("256 registers, expected 1 to 255"));
  CHECK_THAT(complaint([](Program& p) { p.lines.push_back({}); }),
             Contains("9 source lines for 8 instructions"));
  CHECK_THAT(complaint([](Program& p) { p.labels.emplace_back(9, "END"); }),
             Contains("label 'END' stands past the end"));
  CHECK_THAT(complaint([](Program& p) { p.lines[4].file = 1; }), Contains("source file 1 is not declared"));
}
