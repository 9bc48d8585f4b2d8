// Prints programs as text that parse() reads back to the identical program.
// SPDX-License-Identifier: Apache-2.0
#include "isa/text.h"

#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>
#include <vector>

#include "isa/literals.h"
#include "isa/op_row.h"

namespace glint::isa {
namespace {

constexpr size_t kMaxDecimal = 65535;  // Choice: larger literals read better in hexadecimal

std::string literal(uint64_t value, bool is_wide, bool as_float) {
  if (as_float) return is_wide ? fmt::format("0d{:016X}", value) : fmt::format("0f{:08X}", uint32_t(value));
  const int64_t as_signed = is_wide ? int64_t(value) : int64_t(int32_t(uint32_t(value)));
  if (as_signed < 0 && as_signed >= -int64_t(kMaxDecimal)) return fmt::format("{}", as_signed);
  return value <= kMaxDecimal ? fmt::format("{}", value) : fmt::format("0x{:x}", value);
}

// Prints operands. A constant is printed as a literal if parse() would find the same row again, and otherwise
// as its row, "%c7".
class OperandPrinter {
 public:
  OperandPrinter(const Program& program, bool rows_are_listed)
      : program_(program), rows_(rows_are_listed ? program.constants : std::vector<uint32_t>{}) {}

  std::string source(Slot slot, bool is_wide, bool as_float) {
    const unsigned index = slot & kSlotIndexMask;
    if (slot & kSpecialBank)
      return index < unsigned(kNumSpecials) ? std::string(name_of(Special(index)))
                                            : fmt::format("%special{}", index);
    if (!(slot & kConstantBank)) return fmt::format("%r{}{}", is_wide ? "d" : "", index);
    const size_t end = index + (is_wide ? 2 : 1);
    if (end > program_.constants.size()) return fmt::format("%c{}", index);
    const uint64_t value =
        program_.constants[index] | (is_wide ? uint64_t{program_.constants[index + 1]} << 32 : 0);
    const size_t before = rows_.size();
    if (intern_constant(rows_, value, is_wide) == index) return literal(value, is_wide, as_float);
    rows_.resize(before);
    all_found_ = false;
    return fmt::format("%c{}", index);
  }

  // Returns "[%rd4 + 16]", or "[16]" for the constant 0 as base.
  std::string address(Slot slot, int32_t displacement, bool is_wide) {
    const std::string base = source(slot, is_wide, false);
    if ((slot & kConstantBank) && base == "0") return fmt::format("[{}]", displacement);
    if (displacement == 0 && !(slot & kConstantBank)) return fmt::format("[{}]", base);
    return fmt::format("[{} {} {}]", base, displacement < 0 ? '-' : '+', std::abs(int64_t(displacement)));
  }

  // Returns, after all code was printed, whether literals alone rebuild the table.
  bool rebuilds() const { return all_found_ && rows_ == program_.constants; }

 private:
  const Program& program_;
  std::vector<uint32_t> rows_;
  bool all_found_ = true;
};

// Gives names to branch targets: the program's labels, made unique, and "L<index>" where it has none.
class LabelNames {
 public:
  explicit LabelNames(const Program& program) {
    std::set<std::string> used;
    for (const auto& [index, name] : program.labels) add(used, index, name);
    for (const Inst& inst : program.code)
      for (const OperandKind kind : op_table()[inst.op].operands.view())
        if (kind == OperandKind::Label && !names_.count(uint32_t(inst.imm)))
          add(used, uint32_t(inst.imm), fmt::format("L{}", inst.imm));
  }
  std::string at(int32_t target) const {
    const auto it = names_.find(uint32_t(target));
    return it == names_.end() ? fmt::format("@{}", target) : it->second.front();
  }
  void print(std::string& out, uint32_t index) const {
    const auto it = names_.find(index);
    if (it == names_.end()) return;
    for (const std::string& name : it->second) out += name + ":\n";
  }

 private:
  void add(std::set<std::string>& used, uint32_t index, std::string name) {
    while (!used.insert(name).second) name += fmt::format("_{}", index);
    names_[index].push_back(name);
  }
  std::map<uint32_t, std::vector<std::string>> names_;
};

std::string vector_text(OperandPrinter& print, const Inst& inst, int slot, int count, bool as_float) {
  std::string out = "{";
  for (int i = 0; i < count; ++i)
    out += (i ? ", " : "") + print.source(inst.operand[slot + i], false, as_float);
  return out + "}";
}

std::string one_operand(OperandPrinter& print, const OpRow& row, const Inst& inst, OperandKind kind, int slot,
                        const LabelNames* labels) {
  const Slot s = inst.operand[slot];
  switch (kind) {
    case OperandKind::None:
      return "";
    case OperandKind::Label:
      return labels ? labels->at(inst.imm) : fmt::format("@{}", inst.imm);
    case OperandKind::DstPred:
    case OperandKind::SrcPred:
      return fmt::format("%p{}", s);
    case OperandKind::Address64:
      return print.address(s, inst.imm, true);
    case OperandKind::Address32:
      return print.address(s, inst.imm, false);
    case OperandKind::Dst64:
    case OperandKind::Src64:
      return print.source(s, true, is_float(row, slot));
    case OperandKind::Dst32:
    case OperandKind::Src32:
      return print.source(s, false, is_float(row, slot));
    case OperandKind::DstVec2:
    case OperandKind::SrcVec2:
    case OperandKind::DstVec4:
    case OperandKind::SrcVec4:
      return vector_text(print, inst, slot, slots_of(kind), is_float(row, slot));
  }
  return "";
}

std::string inst_text(OperandPrinter& print, const Inst& inst, const LabelNames* labels) {
  const OpRow& row = op_table()[inst.op];
  std::string out;
  if (inst.guard != kNoGuard)
    out = fmt::format("@{}%p{} ", inst.guard & kGuardNegate ? "!" : "", inst.guard & ~kGuardNegate & 0xff);
  out += row.name;
  int slot = 0;
  bool is_first = true, after_destination = false;
  for (const OperandKind kind : row.operands.view()) {
    out += is_first ? " " : after_destination && is_destination(kind) ? "|" : ", ";
    out += one_operand(print, row, inst, kind, slot, labels);
    slot += slots_of(kind);
    is_first = false;
    after_destination = is_destination(kind);
  }
  return out + ";";
}

// Returns the text in quotes. Backslashes, quotes and line ends, which would end the directive, are escaped.
std::string quoted(const std::string& s) {
  std::string out = "\"";
  for (const char c : s) {
    if (c == '\n') {
      out += "\\n";
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string header_text(const Program& p) {
  std::string out = fmt::format(".program {}\n.stage {}\n.registers {}\n", quoted(p.name), name_of(p.stage),
                                p.num_registers);
  if (p.function) out += fmt::format(".function {}\n", p.function);
  if (p.local_bytes) out += fmt::format(".local_bytes {}\n", p.local_bytes);
  if (p.payload_bytes) out += fmt::format(".payload_bytes {}\n", p.payload_bytes);
  if (p.attribute_bytes) out += fmt::format(".attribute_bytes {}\n", p.attribute_bytes);
  if (p.local_size != std::array<uint32_t, 3>{1, 1, 1})
    out += fmt::format(".local_size {} {} {}\n", p.local_size[0], p.local_size[1], p.local_size[2]);
  if (p.shared_bytes) out += fmt::format(".shared_bytes {}\n", p.shared_bytes);
  for (size_t i = 0; i < p.files.size(); ++i) out += fmt::format(".file {} {}\n", i, quoted(p.files[i]));
  for (size_t i = 0; i < p.messages.size(); ++i)
    out += fmt::format(".message {} {}\n", i, quoted(p.messages[i]));
  return out;
}

std::string code_text(const Program& p, OperandPrinter& print) {
  const LabelNames labels(p);
  std::string out;
  Line line;
  for (uint32_t i = 0; i < p.code.size(); ++i) {
    labels.print(out, i);
    if (i < p.lines.size() && !(p.lines[i] == line)) {
      line = p.lines[i];
      out += fmt::format("    .loc {} {}\n", line.file, line.line);
    }
    out += "    " + inst_text(print, p.code[i], &labels) + "\n";
  }
  labels.print(out, uint32_t(p.code.size()));
  return out;
}

}  // namespace

std::string to_text(const Program& program) {
  OperandPrinter literals(program, false);
  std::string code = code_text(program, literals);
  if (literals.rebuilds()) return header_text(program) + "\n" + code;
  // The table has rows that no literal makes, or has them in another order, so it is listed.
  std::string constants;
  for (const uint32_t row : program.constants) constants += fmt::format(".const 0x{:x}\n", row);
  OperandPrinter listed(program, true);
  code = code_text(program, listed);
  return header_text(program) + constants + "\n" + code;
}

std::string to_text(const Program& program, const Inst& inst) {
  OperandPrinter print(program, true);
  return inst_text(print, inst, nullptr);
}

}  // namespace glint::isa
