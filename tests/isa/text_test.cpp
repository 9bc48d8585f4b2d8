// The text of programs: what is printed parses to the identical program, and mistakes are named at their
// place. SPDX-License-Identifier: Apache-2.0
#include "isa/text.h"

#include "base/diagnostics.h"
#include "isa/op_row.h"
#include "isa/reference.h"
#include "isa/verify.h"
#include "tests/support/catch.h"

using namespace glint;
using namespace glint::isa;

namespace {

// A register, constant or special for each source in turn, so that every bank stands in every kind of slot.
Slot some_source(Program& p, bool is_wide, uint32_t& turn) {
  ++turn;
  if (turn % 3 == 0) {
    const uint64_t values[] = {0, 5, 0xffff'fffb, 0x3f80'0000, 0x1234'5678'9abc, ~0ull, 65535, 65536};
    const uint64_t value = values[turn / 3 % 8];
    return Slot(kConstantBank + intern_constant(p.constants, is_wide ? value : uint32_t(value), is_wide));
  }
  if (turn % 3 == 1 && !is_wide) return Slot(kSpecialBank + turn / 3 % kNumSpecials);
  return Slot(2 * (turn % 20));
}

// Every row of the table, guarded and not, then `exit`; labels point at the joins.
Program program_of_all_rows() {
  Program p;
  p.name = "all \"rows\".rgen";
  p.stage = Stage::RayGeneration;
  p.num_registers = 64;
  p.local_bytes = 48;
  p.payload_bytes = 16;
  p.attribute_bytes = 8;
  p.local_size = {8, 4, 1};
  p.files = {"a b.rgen", "c\\d.glsl"};
  uint32_t turn = 0;
  for (size_t round = 0; round < 4; ++round)
    for (size_t op = 0; op < op_table().size(); ++op) {
      const OpRow& row = op_table()[op];
      Inst inst;
      inst.op = uint16_t(op);
      if (round % 2) inst.guard = uint8_t((op % kNumPredicates) | (round == 3 ? kGuardNegate : 0));
      int slot = 0;
      for (const OperandKind kind : row.operands.view()) {
        const bool is_wide = kind == OperandKind::Src64 || kind == OperandKind::Address64;
        if (kind == OperandKind::Address32 || kind == OperandKind::Address64)
          inst.imm = int32_t(turn) * 4 - 400;
        for (const int end = slot + slots_of(kind); slot < end; ++slot) {
          if (kind == OperandKind::DstPred || kind == OperandKind::SrcPred)
            inst.operand[slot] = Slot(++turn % kNumPredicates);
          else if (is_destination(kind))
            inst.operand[slot] = Slot(2 * (++turn % 20));
          else
            inst.operand[slot] = some_source(p, is_wide, turn);
        }
        if (kind == OperandKind::Label) inst.imm = int32_t(op_index("join"));  // of the first round
      }
      p.code.push_back(inst);
      p.lines.push_back({uint16_t(op % 2), uint32_t(op / 3)});
    }
  Inst last;
  last.op = op_index("exit");
  p.code.push_back(last);
  p.lines.push_back({1, 99});
  p.labels = {{0, "START"}, {3, "MIDDLE"}, {uint32_t(op_index("join")), "MEET"}};
  p.shared_bytes = 4096;
  return p;
}

std::string error_of(const std::string& text) {
  try {
    parse(text, "bad.isa");
  } catch (const UserError& e) {
    return e.what();
  }
  return "no error";
}

bool starts(const std::string& s, const std::string& prefix) {
  return s.rfind(prefix, 0) == 0;
}

}  // namespace

TEST_CASE("a program with every row prints and parses to the identical program") {
  const Program p = program_of_all_rows();
  Diagnostics diagnostics;
  verify(p, diagnostics);
  INFO((diagnostics.messages().empty() ? "" : diagnostics.messages().front()));
  CHECK(diagnostics.messages().empty());
  const std::string text = to_text(p);
  const Program q = parse(text, "all");
  CHECK(q == p);
  CHECK(q.labels == p.labels);
  CHECK(to_text(q) == text);
  CHECK(text.find("\n.const") == std::string::npos);  // literals alone rebuild the table
}

TEST_CASE("constant tables in any order, with duplicates and unused rows, survive the text") {
  Program p = program_of_all_rows();
  p.constants.insert(p.constants.begin(), {7, 7, 0xffff'ffff});
  for (Inst& inst : p.code) {
    int slot = 0;
    for (const OperandKind kind : op_table()[inst.op].operands.view())
      for (const int end = slot + slots_of(kind); slot < end; ++slot)
        if (kind != OperandKind::SrcPred && (inst.operand[slot] >> kBankShift) == 1) inst.operand[slot] += 3;
  }
  const std::string text = to_text(p);
  CHECK(text.find("\n.const 0x7\n.const 0x7\n.const 0xffffffff\n") != std::string::npos);
  CHECK(parse(text, "all") == p);
}

TEST_CASE("programs that differ in one field are not equal") {
  const Program p = program_of_all_rows();
  Program q = p;
  q.code[5].imm += 1;
  CHECK_FALSE(q == p);
  q = p;
  q.constants.back() ^= 1;
  CHECK_FALSE(q == p);
  q = p;
  q.lines[9].line += 1;
  CHECK_FALSE(q == p);
  q = p;
  q.shared_bytes ^= 16;
  CHECK_FALSE(q == p);
  CHECK(parse(to_text(q), "q") == q);
}

TEST_CASE("literals keep their bits: decimal, negative, hexadecimal and float") {
  const Program p = parse(
      "add.u32 %r1, 7, -1;\nmul.rn.f32 %r1, 0f3F800000, 0x3f800000;\n"
      "add.u64 %rd2, -2, 0xffffffffffffffff;\nld.const.b32 %r1, [16];\n",
      "p");
  CHECK(p.constants == std::vector<uint32_t>{7, 0xffff'ffff, 0x3f80'0000, 0xffff'fffe, 0xffff'ffff,
                                             0xffff'ffff, 0xffff'ffff, 0});
  CHECK(p.code[1].operand[1] == p.code[1].operand[2]);
  CHECK(p.code[3].imm == 16);
  CHECK(to_text(p, p.code[0]) == "add.u32 %r1, 7, -1;");
  CHECK(to_text(p, p.code[1]) == "mul.rn.f32 %r1, 0f3F800000, 0f3F800000;");
  CHECK(to_text(p, p.code[3]) == "ld.const.b32 %r1, [16];");
}

TEST_CASE("every special has a name that leads back to it") {
  for (int s = 0; s < kNumSpecials; ++s) CHECK(find_special(name_of(Special(s))) == Special(s));
  CHECK(name_of(Special::LaunchSizeX) == "%launch.size.x");
  CHECK(name_of(Special::HitCustomIndex) == "%hit.custom");
  CHECK(name_of(Special::ObjectDirectionZ) == "%object.direction.z");
  CHECK(name_of(Special::WorldToObject11) == "%world_to_object.11");
  CHECK(find_special("%launch.w") == Special::Count);
}

TEST_CASE("the parser names the place of a mistake and what it expected") {
  CHECK(
      starts(error_of("\n  add.u33 %r1, %r2, %r3;"), "bad.isa:2:3: error: found 'add.u33', expected an op"));
  CHECK(error_of("add.u33 %r1, %r2, %r3;").find("did you mean 'add.u32'?") != std::string::npos);
  CHECK(starts(error_of("add.u32 %r1, %r2;"),
               "bad.isa:1:17: error: found ';', expected ',' before operand 3 of add.u32"));
  CHECK(starts(error_of("add.u32 %r1, %r2, %r3"),
               "bad.isa:1:22: error: found the end of the file, expected ';'"));
  CHECK(starts(error_of("add.u32 5, %r2, %r3;"),
               "bad.isa:1:9: error: found '5', expected a register, %r0 to %r254"));
  CHECK(
      starts(error_of("add.u32 %r255, %r2, %r3;"), "bad.isa:1:9: error: found '%r255', expected a register"));
  CHECK(starts(error_of("add.u64 %rd3, %rd2, %rd4;"),
               "bad.isa:1:9: error: found '%rd3', expected an even register"));
  CHECK(starts(error_of("add.u64 %rd2, %rd2, %launch.x;"),
               "bad.isa:1:21: error: found '%launch.x', expected a register pair"));
  CHECK(starts(error_of("add.u32 %r1, %r2, 0x100000000;"),
               "bad.isa:1:19: error: found '0x100000000', expected a register, a special or a 32-bit"));
  CHECK(starts(error_of("@%p8 exit;"), "bad.isa:1:2: error: found '%p8', expected a predicate"));
  CHECK(starts(error_of("L: exit;\nbra M;"),
               "bad.isa:2:5: error: found 'M', expected a label of this program"));
  CHECK(starts(error_of("L: exit;\nL: exit;"),
               "bad.isa:2:1: error: found 'L', expected a label that does not stand twice"));
  CHECK(starts(error_of(".stage compte"), "bad.isa:1:8: error: found 'compte', expected a stage"));
  CHECK(starts(error_of(".file 1 \"x\""), "bad.isa:1:7: error: found '1', expected file 0"));
  CHECK(starts(error_of(".registers 300"),
               "bad.isa:1:12: error: found '300', expected a number of registers (0 to 255)"));
  CHECK(starts(error_of(".program x"), "bad.isa:1:10: error: found 'x', expected a name in quotes"));
  CHECK(starts(error_of(".program \"x"), "bad.isa:1:10: error: found 'x', expected a closing"));
  CHECK(starts(error_of("ld.local.b32 %r1, [%r2 + 4;"),
               "bad.isa:1:27: error: found ';', expected ']' after the address"));
  CHECK(starts(error_of("mov.b32 %r1, 0f3F8000;"),
               "bad.isa:1:14: error: found '0f3F8000', expected a register"));
}

TEST_CASE("the reference shows every op once, and an unknown op is met with the nearest name") {
  const std::string all = reference_markdown();
  for (const OpRow& row : op_table()) {
    const std::string cell = "| `" + std::string(row.name) + "` |";
    INFO(row.name);
    REQUIRE(all.find(cell) != std::string::npos);
    CHECK(all.find(cell, all.find(cell) + 1) == std::string::npos);
    CHECK(describe_op(row.name).find(std::string(row.doc)) != std::string::npos);
  }
  CHECK_THROWS_WITH(describe_op("shl.b33"), Catch::Contains("did you mean 'shl.b32'?"));
}
