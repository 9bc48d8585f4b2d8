// Tests register limits, pairs, coalescing and liveness.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/backend/allocate.h"

#include <algorithm>

#include "base/diagnostics.h"
#include "frontend/backend/liveness.h"
#include "tests/support/catch.h"
#include "tests/unit/backend/code_builder.h"

namespace glint::frontend::test {
namespace {

// Returns code with `values` words that are all live at once. The first word is needed last.
CodeBuilder pressure(int values) {
  CodeBuilder code;
  const Operand address = code.pair();
  std::vector<Operand> words;
  for (int i = 0; i < values; ++i) words.push_back(code.word(16 + 4 * i));
  for (size_t i = words.size(); i-- > 0;) code.add("st.global.b32", {address, words[i]}, int32_t(4 * i));
  code.add("exit");
  return code;
}

TEST_CASE("Values that fit use exactly the registers they need and no memory") {
  const isa::Program program = pressure(12).assembled({.max_registers = 15, .schedule = false});
  REQUIRE(program.num_registers == 15);  // stack pointer, a pair, 12 words
  REQUIRE(program.local_bytes == 0);
  REQUIRE(program.code.size() == 1 + 12 + 12 + 1);
}

TEST_CASE("One register too few spills one value") {
  const isa::Program program = pressure(12).assembled({.max_registers = 14, .schedule = false});
  REQUIRE(program.num_registers <= 14);
  REQUIRE(program.local_bytes == 16);
  REQUIRE(count_of(program, "st.local.b32") == 1);
  REQUIRE(count_of(program, "ld.local.b32") == 1);
}

TEST_CASE("Fewer than 8 registers are refused, and so are more than the machine has") {
  const CodeBuilder code = pressure(1);
  REQUIRE_THROWS_AS(code.assembled({.max_registers = 7}), UserError);
  REQUIRE_THROWS_AS(code.assembled({.max_registers = 256}), UserError);
  REQUIRE_NOTHROW(code.assembled({.max_registers = 8}));
  REQUIRE_NOTHROW(code.assembled({.max_registers = 255}));
}

TEST_CASE("An instruction that reads more values than there are registers is an error of the user") {
  CodeBuilder code;
  std::vector<Operand> operands{code.fresh(RegisterClass::Predicate), code.pair()};
  for (int i = 0; i < 15; ++i) operands.push_back(code.word(4 * i));
  code.add("rt.trace", operands);
  code.add("rt.end");
  code.add("exit");
  REQUIRE_THROWS_AS(code.assembled({.max_registers = 17}), UserError);
  REQUIRE(code.assembled({.max_registers = 18}).num_registers == 18);  // 15 words, a pair, the stack pointer
}

TEST_CASE("Scheduling brings up no more comparisons than there are predicates to keep them in") {
  constexpr int kChains = 12, kRounds = 4;
  CodeBuilder code;
  const Operand address = code.pair(), limit = code.word(8);
  std::vector<Operand> words;
  for (int i = 0; i < kChains; ++i) words.push_back(code.word(16 + 4 * i));
  for (int step = 0; step < kChains * kRounds; ++step) {
    const Operand flag = code.fresh(RegisterClass::Predicate), word = words[size_t(step % kChains)];
    code.add("setp.lt.s32", {flag, word, limit});
    code.add("selp.b32", {word, limit, word, flag});
  }
  for (int i = 0; i < kChains; ++i) code.add("st.global.b32", {address, words[size_t(i)]}, 4 * i);
  code.add("exit");
  const std::vector<std::string> names = names_of(code.assembled());
  // A predicate that must be evicted becomes a selection into a word and a comparison that brings it back.
  REQUIRE(std::count(names.begin(), names.end(), "selp.b32") == kChains * kRounds);
  REQUIRE(std::count(names.begin(), names.end(), "setp.ne.u32") == 0);
  int live = 0, most = 0;
  for (const std::string& name : names) {
    live += name == "setp.lt.s32" ? 1 : name == "selp.b32" ? -1 : 0;
    most = std::max(most, live);
  }
  REQUIRE(most == isa::kNumPredicates - 1);  // one predicate is kept free, or latencies would not overlap
}

TEST_CASE("64-bit values lie in even pairs above the stack pointer") {
  CodeBuilder code;
  const Operand a = code.pair(), b = code.word(), c = code.pair(8);
  code.add("st.global.b32", {a, b});
  code.add("st.global.b64", {a, c});
  code.add("exit");
  const isa::Program program = code.assembled();
  for (const isa::Inst& inst : program.code) {
    if (isa::op_table()[inst.op].name != "st.global.b64") continue;
    REQUIRE(inst.operand[0] % 2 == 0);
    REQUIRE(inst.operand[1] % 2 == 0);
    REQUIRE(inst.operand[0] >= 2);
    REQUIRE(inst.operand[1] >= 2);
  }
}

TEST_CASE("A loop variable and its next value share a register: no move is left") {
  CodeBuilder code;
  const Operand i = code.fresh(RegisterClass::B32), next = code.fresh(RegisterClass::B32);
  const Operand more = code.fresh(RegisterClass::Predicate), address = code.pair();
  code.add("mov.b32", {i, Operand::value(0)});
  code.program.blocks[0].successors = {1};
  const BlockId loop = code.block("loop");
  code.add("st.global.b32", {address, i});
  code.add("add.u32", {next, i, Operand::value(1)});
  code.add("setp.lt.u32", {more, next, Operand::value(9)});
  code.add("mov.b32", {i, next});
  VirtualInst& back = code.add("bra");
  back.target = loop;
  back.guard = more.reg;
  const BlockId done = code.block("done");
  code.program.blocks[loop].successors = {loop, done};
  code.add("exit");
  REQUIRE(count_of(code.assembled(), "mov.b32") == 1);  // the initial move
}

TEST_CASE("Packing values made for the purpose costs nothing") {
  CodeBuilder code;
  const Operand low = code.word(0), high = code.word(4), both = code.fresh(RegisterClass::B64),
                address = code.pair(8);
  code.add("pack.b64", {both, low, high});
  code.add("st.global.b64", {address, both});
  code.add("exit");
  REQUIRE(count_of(code.assembled(), "pack.b64") == 0);
}

TEST_CASE("A guarded definition that only its own guard reads is dead above") {
  CodeBuilder code;
  const Operand flag = code.fresh(RegisterClass::Predicate), value = code.fresh(RegisterClass::B32),
                address = code.pair();
  code.add("setp.eq.u32", {flag, code.word(), Operand::value(0)});
  code.add("ld.global.b32", {value, address}).guard = flag.reg;
  code.add("st.global.b32", {address, value}, 4).guard = flag.reg;
  code.add("exit");
  REQUIRE_FALSE(find_liveness(code.program).in[0].contains(value.reg));
  // The value is written under the opposite guard, so the old value is read.
  code.program.blocks[0].code[3].guard_negate = true;
  REQUIRE(find_liveness(code.program).in[0].contains(value.reg));
}

}  // namespace
}  // namespace glint::frontend::test
