// Tests simplification, scheduling and layout by the exact code that comes out.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/emit.h"

#include <algorithm>

#include "isa/verify.h"
#include "tests/support/catch.h"
#include "tests/unit/backend/code_builder.h"
#include "tests/unit/backend/random_program.h"

namespace glint::frontend::test::emit_test {
namespace {

using Names = std::vector<std::string>;
const BackendOptions kInOrder{.max_registers = 64, .schedule = false};

TEST_CASE("Equal constants share a row and 64-bit constants take two, low half first") {
  ConstantTable table;
  REQUIRE(table.word(5) == isa::kConstantBank + 0);
  REQUIRE(table.pair(0x7'0000'0005) == isa::kConstantBank + 1);
  REQUIRE(table.word(7) == isa::kConstantBank + 2);
  REQUIRE(table.word(5) == isa::kConstantBank + 0);
  REQUIRE(table.pair(0x7'0000'0005) == isa::kConstantBank + 1);
  REQUIRE(table.take() == std::vector<uint32_t>{5, 5, 7});
}

TEST_CASE("Copies, constants and dead results leave no instructions") {
  CodeBuilder code;
  const Operand address = code.pair(), a = code.fresh(RegisterClass::B32), b = code.fresh(RegisterClass::B32);
  code.add("mov.b32", {a, Operand::value(3)});
  code.add("add.u32", {b, a, a});
  code.word(8);
  code.add("st.global.b32", {address, a});
  code.add("exit");
  REQUIRE(names_of(code.assembled(kInOrder)) == Names{"ld.const.b64", "st.global.b32", "exit"});
}

TEST_CASE("Integer products and sums become one instruction") {
  CodeBuilder code;
  const Operand base = code.pair(), index = code.word(8);
  const Operand wide = code.fresh(RegisterClass::B64), shifted = code.fresh(RegisterClass::B64),
                address = code.fresh(RegisterClass::B64);
  code.add("cvt.u64.u32", {wide, index});
  code.add("shl.b64", {shifted, wide, Operand::value(4)});
  code.add("add.u64", {address, base, shifted});
  const Operand moved = code.fresh(RegisterClass::B64);
  code.add("add.u64", {moved, address, Operand::value(32)});
  const Operand product = code.fresh(RegisterClass::B32), sum = code.fresh(RegisterClass::B32);
  code.add("mul.lo.s32", {product, index, index});
  code.add("add.s32", {sum, Operand::value(1), product});
  code.add("st.global.b32", {moved, sum}, 4);
  code.add("exit");
  const isa::Program program = code.assembled(kInOrder);
  REQUIRE(names_of(program) ==
          Names{"ld.const.b64", "ld.const.b32", "mad.wide.u32", "mad.lo.u32", "st.global.b32", "exit"});
  REQUIRE(program.code[4].imm == 36);
  REQUIRE(program.constants[program.code[2].operand[2] & isa::kSlotIndexMask] == 16);
}

TEST_CASE("Branches are inverted, threaded and dropped where control falls through") {
  CodeBuilder code;
  const Operand flag = code.fresh(RegisterClass::Predicate), address = code.pair();
  code.add("setp.eq.u32", {flag, code.word(8), Operand::value(0)});
  code.program.blocks[0].successors = {1, 2};
  VirtualInst& choice = code.add("bra");
  choice.guard = flag.reg;
  choice.target = 1;
  code.add("bra").target = 2;
  code.block("near", {3});
  code.add("st.global.b32", {address, Operand::value(1)});
  code.add("bra").target = 3;
  code.block("hop", {3});
  code.add("bra").target = 3;
  code.block("done");
  code.add("exit");
  const isa::Program program = code.assembled(kInOrder);
  REQUIRE(names_of(program) ==
          Names{"ld.const.b64", "ld.const.b32", "setp.eq.u32", "bra", "st.global.b32", "exit"});
  REQUIRE(int(program.code[3].guard) == isa::kGuardNegate);  // @!%p0
  REQUIRE(program.code[3].imm == 5);
  REQUIRE(program.labels == std::vector<std::pair<uint32_t, std::string>>{{5, "done"}});
}

TEST_CASE("A negated predicate turns the guard around instead") {
  CodeBuilder code;
  const Operand flag = code.fresh(RegisterClass::Predicate), no = code.fresh(RegisterClass::Predicate),
                address = code.pair();
  code.add("setp.eq.u32", {flag, code.word(8), Operand::value(0)});
  code.add("not.pred", {no, flag});
  code.add("st.global.b32", {address, Operand::value(1)}).guard = no.reg;
  code.add("exit");
  const isa::Program program = code.assembled(kInOrder);
  REQUIRE(count_of(program, "not.pred") == 0);
  REQUIRE(int(program.code[3].guard) == isa::kGuardNegate);  // @!%p0
}

TEST_CASE("Scheduling starts independent loads before the first use of any") {
  CodeBuilder code;
  const Operand address = code.pair();
  for (int i = 0; i < 3; ++i) {
    const Operand value = code.fresh(RegisterClass::B32), sum = code.fresh(RegisterClass::B32);
    code.add("ld.global.b32", {value, address}, 4 * i);
    code.add("add.u32", {sum, value, value});
    code.add("st.local.b32", {Operand::stack_pointer(), sum}, 4 * i);
  }
  code.add("exit");
  const Names names = names_of(code.assembled());
  const auto first_add = std::find(names.begin(), names.end(), "add.u32");
  REQUIRE(std::count(names.begin(), first_add, "ld.global.b32") == 3);
}

TEST_CASE("Scheduling puts a comparison before longer chains when its predicate guards late") {
  const auto place = [](uint32_t guard_latency) {
    CodeBuilder code;
    const Operand address = code.pair(), a = code.word(16), flag = code.fresh(RegisterClass::Predicate);
    for (int i = 0; i < 8; ++i) {
      const Operand product = code.fresh(RegisterClass::B32), sum = code.fresh(RegisterClass::B32);
      code.add("mul.hi.u32", {product, a, Operand::value(uint64_t(3 + i))});
      code.add("xor.b32", {sum, product, a});
      code.add("st.local.b32", {Operand::stack_pointer(), sum}, 4 * i);
    }
    code.add("setp.lt.u32", {flag, a, Operand::value(5)});
    code.add("st.global.b32", {address, a}).guard = flag.reg;
    code.add("exit");
    const Names names = names_of(code.assembled({.guard_latency = guard_latency}));
    return std::count(names.begin(), std::find(names.begin(), names.end(), "setp.lt.u32"), "mul.hi.u32");
  };

  REQUIRE(place(0) == 8);
  REQUIRE(place(9) == 0);
}

TEST_CASE("Scheduling keeps the order of a store and a load that may overlap") {
  CodeBuilder code;
  const Operand a = code.pair(), b = code.pair(8), value = code.fresh(RegisterClass::B32);
  const Operand product = code.fresh(RegisterClass::B32);
  code.add("mul.lo.u32", {product, code.word(16), Operand::value(3)});
  code.add("st.global.b32", {a, product});
  code.add("ld.global.b32", {value, b});
  code.add("st.local.b32", {Operand::stack_pointer(), value});
  code.add("exit");
  const Names names = names_of(code.assembled());
  REQUIRE(std::find(names.begin(), names.end(), "st.global.b32") <
          std::find(names.begin(), names.end(), "ld.global.b32"));
}

TEST_CASE("Whatever is assembled passes the verifier") {
  for (uint32_t seed = 1; seed <= 40; ++seed) {
    const VirtualProgram program = RandomProgram(seed, {.statements = 60, .values = 10}).take();
    Diagnostics diagnostics;
    isa::verify(assemble(program, {.max_registers = 8 + seed}), diagnostics);
    INFO("seed " << seed << (diagnostics.messages().empty() ? "" : ": " + diagnostics.messages().front()));
    REQUIRE_FALSE(diagnostics.has_errors());
  }
}

}  // namespace
}  // namespace glint::frontend::test::emit_test
