// Tests what is saved around calls, and where.
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.h"
#include "tests/unit/backend/code_builder.h"

namespace glint::frontend::test {
namespace {

using Names = std::vector<std::string>;

void call(CodeBuilder& code) {
  code.marker(VirtualInst::Kind::SaveLive);
  code.add("call.sbt.hit");
  code.marker(VirtualInst::Kind::RestoreLive);
}

TEST_CASE("Only values that are live across a call are saved, four words per instruction") {
  CodeBuilder code;
  code.program.local_bytes = 20;
  const Operand address = code.pair();
  std::vector<Operand> kept;
  for (int i = 0; i < 3; ++i) kept.push_back(code.word(16 + 4 * i));
  const Operand dead = code.word(64);
  code.add("st.global.b32", {address, dead}, 100);
  call(code);
  for (int k = 0; k < 2; ++k)  // with two reads each, saving is cheaper than keeping in memory
    for (const Operand& value : kept) code.add("st.global.b32", {address, value}, 4 * k);
  code.add("ret");
  const isa::Program program = code.assembled({.max_registers = 64, .schedule = false});
  // 3 words and a pair are 5 words: one vector of four and one word.
  REQUIRE(count_of(program, "st.local.v4.b32") == 1);
  REQUIRE(count_of(program, "st.local.b32") == 1);
  REQUIRE(count_of(program, "ld.local.v4.b32") == 1);
  REQUIRE(count_of(program, "ld.local.b32") == 1);
  REQUIRE(program.local_bytes == 64);  // 20 rounds to 32, 5 words round to 32
}

TEST_CASE("A call with nothing to save and no frame costs one instruction") {
  CodeBuilder code;
  call(code);
  code.add("ret");
  REQUIRE(names_of(code.assembled()) == Names{"call.sbt.hit", "ret"});
}

TEST_CASE("The stack pointer moves by the whole frame and back") {
  CodeBuilder code;
  code.program.local_bytes = 40;
  call(code);
  code.add("ret");
  const isa::Program program = code.assembled();
  REQUIRE(names_of(program) == Names{"add.u32", "call.sbt.hit", "sub.u32", "ret"});
  for (size_t i : {size_t{0}, size_t{2}}) {
    REQUIRE(program.code[i].operand[0] == isa::kStackPointer);
    REQUIRE(program.code[i].operand[1] == isa::kStackPointer);
    REQUIRE(program.constants[program.code[i].operand[2] & isa::kSlotIndexMask] == 48);
  }
}

TEST_CASE("A predicate that is live across a call travels through the frame as 0 or 1") {
  CodeBuilder code;
  const Operand address = code.pair(), flag = code.fresh(RegisterClass::Predicate);
  code.add("setp.eq.u32", {flag, code.word(), Operand::value(3)});
  code.add("st.global.b32", {address, Operand::value(1)}).guard = flag.reg;
  call(code);
  const Operand again = code.pair();
  code.add("st.global.b32", {again, Operand::value(1)}).guard = flag.reg;
  code.add("ret");
  const isa::Program program = code.assembled({.max_registers = 64, .schedule = false});
  REQUIRE(count_of(program, "selp.b32") == 1);
  REQUIRE(count_of(program, "setp.ne.u32") == 1);
  REQUIRE(count_of(program, "st.local.b32") == 1);
  REQUIRE(count_of(program, "ld.local.b32") == 1);
}

TEST_CASE("A value that crosses more calls than it has uses stays in memory") {
  CodeBuilder code;
  const Operand value = code.word();
  for (int i = 0; i < 8; ++i) call(code);
  const Operand address = code.pair();
  code.add("st.global.b32", {address, value});
  code.add("ret");
  const isa::Program program = code.assembled();
  REQUIRE(count_of(program, "st.local.b32") == 1);
  REQUIRE(count_of(program, "ld.local.b32") == 1);
}

}  // namespace
}  // namespace glint::frontend::test
