// Tests the text of programs: printed text parses to the identical program, and mistakes are reported at
// their place.
// SPDX-License-Identifier: Apache-2.0
#include "isa/text.h"

#include <algorithm>

#include "base/diagnostics.h"
#include "isa/op_row.h"
#include "isa/paths.h"
#include "isa/reference.h"
#include "isa/verify.h"
#include "tests/support/catch.h"

using namespace glint;
using namespace glint::isa;

namespace {

// Returns a register, constant or special register for each source in turn, so that every bank appears in
// every kind of slot.
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

// Returns a program with every row of the table, with and without guard, then `exit`. Labels point at the
// joins.
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

Inst simple(std::string_view op, std::initializer_list<Slot> operands = {}, int32_t imm = 0) {
  Inst inst;
  inst.op = op_index(op);
  inst.imm = imm;
  std::copy(operands.begin(), operands.end(), inst.operand.begin());
  return inst;
}

// Returns a program for a shader of `stage` that writes all registers and predicates and then executes `op`
// in surroundings where it makes sense.
Program program_of_one_row(uint16_t op, Stage stage) {
  Program p;
  p.name = "one row";
  p.stage = stage;
  p.num_registers = 64;
  p.local_bytes = 0;
  p.constants = {0, 0};
  for (Slot r = 1; r < 64; ++r) p.code.push_back(simple("mov.b32", {r, Slot(kSpecialBank)}));
  for (Slot q = 0; q < kNumPredicates; ++q) p.code.push_back(simple("setp.eq.u32", {q, Slot(1 + q), 9}));
  const OpRow& row = op_table()[op];
  const Effect e = row.effect;
  const bool in_trace =
      e == Effect::Resume || e == Effect::CallCandidate || e == Effect::CallHit || e == Effect::EndTrace;
  if (in_trace) {
    Inst trace = simple("rt.trace", {0, 2});
    for (size_t i = 2; i < 17; ++i) trace.operand[i] = 4;
    p.code.push_back(trace);
  }
  if (e == Effect::Join) p.code.push_back(simple("ssy", {}, int32_t(p.code.size()) + 1));
  Inst inst;
  inst.op = op;
  int slot = 0;
  Slot number = 0;
  for (const OperandKind kind : row.operands.view()) {
    if (kind == OperandKind::Label) inst.imm = int32_t(p.code.size()) + (e == Effect::Call ? 2 : 1);
    const bool is_predicate = kind == OperandKind::DstPred || kind == OperandKind::SrcPred;
    for (const int end = slot + slots_of(kind); slot < end; ++slot)
      inst.operand[size_t(slot)] = is_predicate ? Slot(number++ % kNumPredicates) : Slot(2 + 2 * number++);
  }
  if (e == Effect::Print || e == Effect::PrintPart) {  // the message's number must be a constant
    p.messages = {"%d \"%x\"\n"};
    inst.operand[0] = kConstantBank;
  }
  p.code.push_back(inst);
  const bool is_entry = stage == Stage::RayGeneration || stage == Stage::Compute;
  const Inst last = simple(is_entry ? "exit" : "ret");
  if (e == Effect::PushReconvergence) p.code.push_back(simple("join"));
  if (e == Effect::BranchIndexed) p.code.push_back(simple("bra", {}, int32_t(p.code.size()) + 1));
  if (e == Effect::Trace || (in_trace && e != Effect::EndTrace)) p.code.push_back(simple("rt.end"));
  if (!ends_lanes(e)) p.code.push_back(last);
  if (e == Effect::Call) p.code.push_back(simple("ret"));
  p.lines.resize(p.code.size());
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
  const std::string text = to_text(p);
  const Program q = parse(text, "all");
  CHECK(q == p);
  CHECK(q.labels == p.labels);
  CHECK(to_text(q) == text);
  CHECK(text.find("\n.const") == std::string::npos);  // literals alone rebuild the table
}

TEST_CASE("every row stands in a sound program of some stage, which survives its text") {
  for (size_t op = 0; op < op_table().size(); ++op) {
    INFO(op_table()[op].name);
    std::string first_message = "no stage";
    bool is_sound = false;
    for (int stage = int(Stage::Compute); stage >= 0 && !is_sound; --stage) {
      const Program p = program_of_one_row(uint16_t(op), Stage(stage));
      Diagnostics diagnostics;
      verify(p, diagnostics);
      is_sound = diagnostics.messages().empty();
      if (!is_sound) {
        first_message = diagnostics.messages().front();
        continue;
      }
      const std::string text = to_text(p);
      const Program q = parse(text, "one row");
      CHECK(to_text(q) == text);
      CHECK(std::equal(
          p.code.begin(), p.code.end(), q.code.begin(), q.code.end(), [](const Inst& a, const Inst& b) {
            return a.op == b.op && a.guard == b.guard && a.imm == b.imm && a.operand == b.operand;
          }));
    }
    INFO(first_message);
    CHECK(is_sound);
  }
}

TEST_CASE("two destinations are written with a bar between them") {
  Program p;
  p.num_registers = 64;
  for (size_t op = 0; op < op_table().size(); ++op) {
    const OpRow& row = op_table()[op];
    if (row.operands.count < 2 || !is_destination(row.operands.kind[1])) continue;
    const Program one = program_of_one_row(uint16_t(op), Stage::Compute);
    const auto at = std::find_if(one.code.begin(), one.code.end(), [&](const Inst& i) { return i.op == op; });
    const std::string text = to_text(one, *at);
    INFO(text);
    const size_t bar = text.find('|');
    CHECK(bar != std::string::npos);
    std::string comma = text;
    comma.replace(bar, 1, ", ");
    CHECK(starts(error_of(".registers 64\n" + comma), "bad.isa:2:"));
    CHECK(error_of(".registers 64\n" + comma).find("expected '|' before operand 2") != std::string::npos);
  }
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

TEST_CASE("where an op takes a float, a fraction is the nearest float and 0d its bits") {
  const Program p = parse(
      "mul.rn.f32 %r1, 1.5, -0.1;\nmul.rn.f32 %r1, 2e-3, 1.0;\nmul.rn.f32 %r1, 5, 16777217.0;\n"
      "setp.lt.f32 %p0, %r1, -0.0;\n",
      "p");
  CHECK(p.constants == std::vector<uint32_t>{0x3fc0'0000, 0xbdcc'cccd, 0x3b03'126f, 0x3f80'0000, 5,
                                             0x4b80'0000, 0x8000'0000});
  CHECK(parse(to_text(p), "p") == p);
  CHECK(starts(error_of("add.u32 %r1, %r2, 1.5;"),
               "bad.isa:1:19: error: found '1.5', expected a register, a special or"));
  CHECK(error_of("add.u32 %r1, %r2, 1.5;").find("this operand is not a float") != std::string::npos);
  CHECK(starts(error_of("mul.rn.f32 %r1, 1.5x, 1.0;"), "bad.isa:1:17: error: found '1.5x'"));
  CHECK(starts(error_of("mul.rn.f32 %r1, 1e99, 1.0;"), "bad.isa:1:17: error: found '1e99'"));
  if (find_op("mul.rn.f64") < 0) return;
  const Program q = parse("mul.rn.f64 %rd2, 1.5, 0d3FF0000000000000;\n", "q");
  CHECK(q.constants == std::vector<uint32_t>{0, 0x3ff8'0000, 0, 0x3ff0'0000});
  CHECK(to_text(q, q.code[0]) == "mul.rn.f64 %rd2, 0d3FF8000000000000, 0d3FF0000000000000;");
}

TEST_CASE("operands that are nearly right are met with a note") {
  const auto note = [](const std::string& text) {
    const std::string e = error_of(text);
    const size_t at = e.find("note: ");
    return at == std::string::npos ? "none: " + e : e.substr(at + 6);
  };
  CHECK(note("mov.b32 %r1, %launch.w;").find("did you mean '%launch.") == 0);
  CHECK(note("mov.b32 %r1, %lanid;").find("did you mean '%laneid'?") == 0);
  CHECK(note("add.u64 %r2, %rd2, %rd4;").find("did you mean '%rd2'?") == 0);
  CHECK(note("add.u64 %rd2, %r3, %rd4;").find("a pair is named by its even low half") == 0);
  CHECK(note("add.u32 %r2, %rd2, 1;").find("did you mean '%r2'?") == 0);
  CHECK(note("add.u64 %rd2, %laneid, 1;").find("specials have 32 bits") == 0);
  CHECK(note("add.u32 %r2, %p2, 1;").find("a predicate becomes a number by selp.b32") == 0);
  CHECK(note("not.pred %p1, %r2;").find("did you mean '%p2'?") == 0);
  CHECK(note("LOOP: bra LOP;").find("did you mean 'LOOP'?") == 0);
  CHECK(note("mov.b32 %r1, %c3;").find("the program lists 0 constant rows") == 0);
  CHECK(note(".stage comput").find("did you mean 'compute'?") == 0);
  CHECK(note(".registers 4\n.locl_bytes 3").find("did you mean '.local_bytes'?") == 0);
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
               "bad.isa:2:1: error: found 'L', expected a label that is not defined twice"));
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

TEST_CASE(
    "the reference shows every op once with its times, and an unknown op is met with the nearest name") {
  PresetTimes times{"tiny", {}};
  for (uint32_t unit = 0; unit < times.unit.size(); ++unit) times.unit[unit] = {100 + unit, 50 + unit};
  const std::vector<PresetTimes> presets{times};
  const std::string index = reference_index(presets), table = instruction_table(times);
  for (const Family& family : families()) {
    const std::string page = reference_page(page_name(family.name), presets);
    CHECK(index.find("(isa/" + page_name(family.name) + ".md)") != std::string::npos);
    for (const OpRow& row : op_table().subspan(family.first, family.count)) {
      const std::string cell = "| `" + std::string(row.name) + "` |";
      INFO(row.name);
      const size_t at = page.find(cell);
      REQUIRE(at != std::string::npos);
      CHECK(page.find(cell, at + 1) == std::string::npos);
      const std::string unit = std::to_string(100 + int(row.unit)),
                        interval = std::to_string(50 + int(row.unit));
      CHECK(page.substr(at, page.find('\n', at) - at).find("| " + unit + "/" + interval + " |") !=
            std::string::npos);
      CHECK(table.find("\n" + std::string(row.name) + "," + std::string(name_of(row.unit)) + ",") !=
            std::string::npos);
      const std::string alone = describe_op(row.name, presets);
      CHECK(alone.find(std::string(row.doc)) != std::string::npos);
      CHECK(alone.find("tiny: latency " + unit + ", interval " + interval) != std::string::npos);
    }
  }
  CHECK(describe_op("fma.rn", presets).find("fma.rn.f32 ") != std::string::npos);
  CHECK_THROWS_WITH(describe_op("shl.b33", presets), Catch::Contains("did you mean 'shl.b32'?"));
  CHECK_THROWS_WITH(reference_page("flaot", presets), Catch::Contains("did you mean 'float'?"));
}
