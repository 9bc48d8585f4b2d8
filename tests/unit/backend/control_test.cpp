// Tests the exact control flow that is left of selections, joins and loops.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/liveness.h"
#include "tests/support/catch.h"
#include "tests/unit/backend/code_builder.h"

namespace glint::frontend::test {
namespace {

using Names = std::vector<std::string>;
const BackendOptions kInOrder{.max_registers = 64, .schedule = false};

// Builds: ssy merge; @!flag bra (else or merge); then...; [else...;] merge: join. The blocks are entry, then,
// else and merge.
struct Selection {
  CodeBuilder code;
  Operand address, flag;

  Selection() {
    address = code.pair();
    flag = code.fresh(RegisterClass::Predicate);
    code.add("setp.eq.u32", {flag, code.word(8), Operand::value(0)});
  }
  void open_then(BlockId otherwise) {
    code.add("ssy").target = 3;
    VirtualInst& branch = code.add("bra");
    branch.guard = flag.reg;
    branch.guard_negate = true;
    branch.target = otherwise;
    code.program.blocks[0].successors = {1, otherwise};
    code.block("then", {3});
  }
  void open_else() {
    code.add("bra").target = 3;
    code.block("else", {3});
  }
  void open_merge() {
    code.block("merge");
    code.add("join");
  }
};

TEST_CASE("A short arm becomes guarded instructions") {
  Selection s;
  s.open_then(3);
  for (int i = 0; i < 4; ++i) s.code.add("st.global.b32", {s.address, Operand::value(1)}, 4 * i);
  s.code.add("bra").target = 3;
  s.code.block("unused");
  s.open_merge();
  s.code.add("exit");
  const isa::Program program = s.code.assembled(kInOrder);
  REQUIRE(names_of(program) == Names{"ld.const.b64", "ld.const.b32", "setp.eq.u32", "st.global.b32",
                                     "st.global.b32", "st.global.b32", "st.global.b32", "exit"});
  for (size_t i = 3; i < 7; ++i) REQUIRE(int(program.code[i].guard) == 0);
}

TEST_CASE("An arm of five instructions keeps its branch and its join") {
  Selection s;
  s.open_then(3);
  for (int i = 0; i < 5; ++i) s.code.add("st.global.b32", {s.address, Operand::value(1)}, 4 * i);
  s.open_else();
  s.code.program.blocks[2].successors.clear();
  s.code.add("exit");
  s.open_merge();
  s.code.add("exit");
  const isa::Program program = s.code.assembled(kInOrder);
  REQUIRE(count_of(program, "ssy") == 1);
  REQUIRE(count_of(program, "join") == 1);
  REQUIRE(count_of(program, "bra") == 1);
}

TEST_CASE("Two arms that choose a value become selp") {
  Selection s;
  const Operand a = s.code.word(16), b = s.code.word(20), chosen = s.code.fresh(RegisterClass::B32);
  s.open_then(2);
  s.code.add("mov.b32", {chosen, a});
  s.open_else();
  s.code.add("mov.b32", {chosen, b});
  s.open_merge();
  s.code.add("st.global.b32", {s.address, chosen});
  s.code.add("exit");
  const isa::Program program = s.code.assembled(kInOrder);
  REQUIRE(names_of(program) == Names{"ld.const.b64", "ld.const.b32", "setp.eq.u32", "ld.const.b32",
                                     "ld.const.b32", "selp.b32", "st.global.b32", "exit"});
  REQUIRE(program.code[5].operand[1] == program.code[3].operand[0]);  // the flag is true in `then`
  REQUIRE(program.code[5].operand[2] == program.code[4].operand[0]);
}

TEST_CASE("A value that one arm only passes on is changed in place by the other") {
  Selection s;
  const Operand a = s.code.word(16), chosen = s.code.fresh(RegisterClass::B32);
  s.open_then(2);
  s.code.add("not.b32", {chosen, a});
  s.open_else();
  s.code.add("mov.b32", {chosen, a});
  s.open_merge();
  s.code.add("st.global.b32", {s.address, chosen});
  s.code.add("exit");
  const isa::Program program = s.code.assembled(kInOrder);
  REQUIRE(names_of(program) == Names{"ld.const.b64", "ld.const.b32", "setp.eq.u32", "ld.const.b32", "not.b32",
                                     "st.global.b32", "exit"});
  REQUIRE(program.code[4].operand[0] == program.code[4].operand[1]);
  REQUIRE(int(program.code[4].guard) == 0);
}

TEST_CASE("A join that lanes reach over one edge disappears with its ssy") {
  Selection s;
  s.open_then(3);
  for (int i = 0; i < 6; ++i) s.code.add("st.global.b32", {s.address, Operand::value(1)}, 4 * i);
  s.code.add("exit");  // never reaches the merge
  s.code.program.blocks[1].successors.clear();
  s.code.block("unused");
  s.open_merge();
  s.code.add("st.global.b32", {s.address, Operand::value(2)});
  s.code.add("exit");
  const isa::Program program = s.code.assembled(kInOrder);
  REQUIRE(count_of(program, "ssy") == 0);
  REQUIRE(count_of(program, "join") == 0);
}

TEST_CASE("A join where two paths meet stays") {
  Selection s;
  s.open_then(2);
  for (int i = 0; i < 6; ++i) s.code.add("st.global.b32", {s.address, Operand::value(1)}, 4 * i);
  s.open_else();
  for (int i = 0; i < 6; ++i) s.code.add("st.global.b32", {s.address, Operand::value(2)}, 4 * i);
  s.open_merge();
  s.code.add("exit");
  const isa::Program program = s.code.assembled(kInOrder);
  REQUIRE(count_of(program, "ssy") == 1);
  REQUIRE(count_of(program, "join") == 1);
}

TEST_CASE("A loop that tests at its top branches once an iteration") {
  CodeBuilder code;
  const Operand i = code.fresh(RegisterClass::B32), more = code.fresh(RegisterClass::Predicate),
                address = code.pair();
  code.add("mov.b32", {i, Operand::value(0)});
  code.add("ssy").target = 3;
  code.program.blocks[0].successors = {1};
  code.block("test", {2, 3});
  code.add("setp.lt.u32", {more, i, Operand::value(9)});
  VirtualInst& leave = code.add("bra");
  leave.guard = more.reg;
  leave.guard_negate = true;
  leave.target = 3;
  code.block("body", {1});
  code.add("st.global.b32", {address, i});
  code.add("add.u32", {i, i, Operand::value(1)});
  code.add("bra").target = 1;
  code.block("done");
  code.add("join");
  code.add("exit");
  const isa::Program program = code.assembled(kInOrder);
  REQUIRE(names_of(program) == Names{"ld.const.b64", "mov.b32", "ssy", "setp.lt.u32", "bra", "st.global.b32",
                                     "add.u32", "setp.lt.u32", "bra", "join", "exit"});
  REQUIRE(program.code[8].imm == 5);
  REQUIRE(int(program.code[8].guard) == 0);
  REQUIRE(int(program.code[4].guard) == isa::kGuardNegate);
  REQUIRE(program.code[4].imm == 9);
}

TEST_CASE("Writes under opposite guards end the old value, writes under equal guards do not") {
  CodeBuilder code;
  const Operand flag = code.fresh(RegisterClass::Predicate), value = code.fresh(RegisterClass::B32),
                address = code.pair();
  code.add("setp.eq.u32", {flag, code.word(), Operand::value(0)});
  code.add("mov.b32", {value, Operand::value(1)}).guard = flag.reg;
  code.add("mov.b32", {value, Operand::value(2)}).guard = flag.reg;
  code.add("st.global.b32", {address, value});
  REQUIRE(find_liveness(code.program).in[0].contains(value.reg));
  code.program.blocks[0].code[4].guard_negate = true;
  REQUIRE_FALSE(find_liveness(code.program).in[0].contains(value.reg));
}

}  // namespace
}  // namespace glint::frontend::test
