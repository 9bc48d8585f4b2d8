// Parses the text of a program (isa/text.h). Newlines end directives, and semicolons end instructions.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "base/diagnostics.h"
#include "isa/literals.h"
#include "isa/op_row.h"
#include "isa/text.h"
#include "isa/tokens.h"

namespace glint::isa {
namespace {

// Returns the number in a name: "%rd4" with the prefix "%rd" gives 4.
std::optional<uint64_t> numbered(const std::string& text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return {};
  return digits(std::string_view(text).substr(prefix.size()), 10);
}

class Parser {
 public:
  Parser(const std::string& text, const std::string& file) : tokens_(text, file) {}

  Program run() {
    program_.name = "";
    for (tokens_.skip_newlines(); tokens_.peek().kind != Token::Kind::End; tokens_.skip_newlines())
      statement();
    resolve_labels();
    return std::move(program_);
  }

 private:
  void statement() {
    const Token& t = tokens_.peek();
    if (t.kind == Token::Kind::Word && t.text[0] == '.') return directive();
    if (t.kind == Token::Kind::Punctuation && t.text == "@") return instruction();
    if (t.kind != Token::Kind::Word) tokens_.fail(t, "a directive, a label or an instruction");
    const Token word = tokens_.take();
    if (!tokens_.take_if(":")) return instruction_named(word, kNoGuard);
    const uint32_t here = uint32_t(program_.code.size());
    if (!label_at_.emplace(word.text, here).second) tokens_.fail(word, "a label that is not defined twice");
    program_.labels.emplace_back(here, word.text);
  }

  // --- Directives

  void directive() {
    const Token name = tokens_.take();
    const std::string& d = name.text;
    if (d == ".program")
      program_.name = string_value();
    else if (d == ".stage")
      stage();
    else if (d == ".registers")
      program_.num_registers = small("a number of registers", kMaxRegisters);
    else if (d == ".function")
      program_.function = small("a number of a function");
    else if (d == ".local_bytes")
      program_.local_bytes = small("a number of bytes");
    else if (d == ".payload_bytes")
      program_.payload_bytes = small("a number of bytes");
    else if (d == ".attribute_bytes")
      program_.attribute_bytes = small("a number of bytes");
    else if (d == ".local_size")
      for (uint32_t& n : program_.local_size) n = small("three sizes");
    else if (d == ".shared_bytes")
      program_.shared_bytes = small("a number of bytes");
    else if (d == ".const")
      program_.constants.push_back(small("the value of a row"));
    else if (d == ".file")
      file();
    else if (d == ".message")
      message();
    else if (d == ".loc")
      location();
    else
      tokens_.fail(name, "a directive",
                   did_you_mean(d, {".program", ".stage", ".registers", ".function", ".local_bytes",
                                    ".payload_bytes", ".attribute_bytes", ".local_size", ".shared_bytes",
                                    ".const", ".file", ".message", ".loc"}));
    if (tokens_.peek().kind != Token::Kind::Newline && tokens_.peek().kind != Token::Kind::End)
      tokens_.fail(tokens_.peek(), "the end of the line after " + d);
  }
  static std::string did_you_mean(const std::string& word, const std::vector<std::string>& all) {
    const std::string near = nearest(word, all);
    return near.empty() ? "" : "did you mean '" + near + "'?";
  }
  std::string string_value() {
    if (tokens_.peek().kind != Token::Kind::String) tokens_.fail(tokens_.peek(), "a name in quotes");
    return tokens_.take().text;
  }
  uint64_t unsigned_number(std::string_view what, uint64_t max) {
    const Token t = tokens_.peek();
    const std::optional<uint64_t> value = t.kind == Token::Kind::Word ? number(t.text) : std::nullopt;
    if (!value || *value > max) tokens_.fail(t, fmt::format("{} (0 to {})", what, max));
    tokens_.take();
    return *value;
  }
  uint32_t small(std::string_view what, uint32_t max = std::numeric_limits<uint32_t>::max()) {
    return uint32_t(unsigned_number(what, max));
  }
  void stage() {
    const Token t = tokens_.peek();
    if (!find_stage(t.text, program_.stage))
      tokens_.fail(t, "a stage",
                   did_you_mean(t.text, {"ray_generation", "intersection", "any_hit", "closest_hit", "miss",
                                         "callable", "compute"}));
    tokens_.take();
  }
  void file() {
    const Token at = tokens_.peek();
    if (small("the index of a file") != program_.files.size())
      tokens_.fail(at, fmt::format("file {}: files are numbered from 0 in order", program_.files.size()));
    program_.files.push_back(string_value());
  }
  void message() {
    const Token at = tokens_.peek();
    if (small("the index of a message") != program_.messages.size())
      tokens_.fail(
          at, fmt::format("message {}: messages are numbered from 0 in order", program_.messages.size()));
    program_.messages.push_back(string_value());
  }
  void location() {
    line_.file = uint16_t(small("the index of a file", 0xffff));
    line_.line = small("a line");
  }

  // --- Instructions

  void instruction() {
    tokens_.take();
    const bool negate = tokens_.take_if("!");
    const uint8_t guard = uint8_t(predicate()) | (negate ? kGuardNegate : uint8_t{0});
    const Token name = tokens_.peek();
    if (name.kind != Token::Kind::Word) tokens_.fail(name, "an op after the guard");
    tokens_.take();
    instruction_named(name, guard);
  }
  void instruction_named(const Token& name, uint8_t guard) {
    const int index = find_op(name.text);
    if (index < 0) {
      std::vector<std::string> names;
      for (const OpRow& row : op_table()) names.emplace_back(row.name);
      tokens_.fail(name, "an op", did_you_mean(name.text, names));
    }
    Inst inst;
    inst.op = uint16_t(index);
    inst.guard = guard;
    const OpRow& row = op_table()[inst.op];
    int slot = 0, position = 0;
    bool after_destination = false;
    for (const OperandKind kind : row.operands.view()) {
      const bool is_second = after_destination && is_destination(kind);
      if (position++)
        tokens_.expect(is_second ? "|" : ",", fmt::format("before operand {} of {}", position, row.name));
      as_float_ = is_float(row, slot);
      operand(inst, kind, slot);
      slot += slots_of(kind);
      after_destination = is_destination(kind);
    }
    tokens_.expect(";", fmt::format("after the {} operands of {}", row.operands.count, row.name));
    program_.code.push_back(inst);
    program_.lines.push_back(line_);
  }

  void operand(Inst& inst, OperandKind kind, int slot) {
    switch (kind) {
      case OperandKind::None:
        return;
      case OperandKind::Label:
        return label();
      case OperandKind::DstPred:
      case OperandKind::SrcPred:
        inst.operand[slot] = predicate();
        return;
      case OperandKind::Dst32:
        inst.operand[slot] = destination(false);
        return;
      case OperandKind::Dst64:
        inst.operand[slot] = destination(true);
        return;
      case OperandKind::Src32:
        inst.operand[slot] = source(false);
        return;
      case OperandKind::Src64:
        inst.operand[slot] = source(true);
        return;
      case OperandKind::Address32:
        return address(inst, slot, false);
      case OperandKind::Address64:
        return address(inst, slot, true);
      case OperandKind::DstVec2:
      case OperandKind::DstVec4:
      case OperandKind::SrcVec2:
      case OperandKind::SrcVec4:
        return vector(inst, kind, slot);
    }
  }
  void label() {
    const Token t = tokens_.peek();
    tokens_.take_word("a label");
    targets_.push_back({uint32_t(program_.code.size()), t});
  }
  void vector(Inst& inst, OperandKind kind, int slot) {
    const int count = slots_of(kind);
    tokens_.expect("{", fmt::format("and {} registers", count));
    for (int i = 0; i < count; ++i) {
      if (i) tokens_.expect(",", fmt::format("and {} more of {} registers", count - i, count));
      inst.operand[slot + i] = is_destination(kind) ? destination(false) : source(false);
    }
    tokens_.expect("}", fmt::format("after {} registers", count));
  }
  // Returns notes for operands that are nearly right.
  static std::string near_operand(const std::string& word) {
    if (const auto index = numbered(word, "%r"); index && *index < uint64_t(kNumPredicates))
      return fmt::format("did you mean '%p{}'?", *index);
    return "";
  }
  static std::string near_register(const std::string& word, bool is_wide) {
    if (const auto index = numbered(word, is_wide ? "%r" : "%rd"); index && *index < uint64_t(kMaxRegisters))
      return is_wide && *index % 2 ? "a pair is named by its even low half"
                                   : fmt::format("did you mean '%r{}{}'?", is_wide ? "d" : "", *index);
    if (numbered(word, "%p")) return "a predicate becomes a number by selp.b32";
    return "";
  }
  std::string near_source(const std::string& word, bool is_wide) const {
    if (fraction(word, is_wide)) return "this operand is not a float: write its bits, as 0f3F800000";
    if (numbered(word, "%c"))
      return fmt::format("the program lists {} constant rows (.const)", program_.constants.size());
    if (is_wide && find_special(word) != Special::Count)
      return "specials have 32 bits: copy it into a register first";
    const std::string note = near_register(word, is_wide);
    if (!note.empty() || is_wide || word[0] != '%') return note;
    std::vector<std::string> names;
    for (int i = 0; i < kNumSpecials; ++i) names.emplace_back(name_of(Special(i)));
    return did_you_mean(word, names);
  }
  Slot predicate() {
    const Token t = tokens_.peek();
    const auto index = numbered(t.text, "%p");
    if (!index || *index >= uint64_t(kNumPredicates))
      tokens_.fail(t, "a predicate, %p0 to %p7", near_operand(t.text));
    tokens_.take();
    return Slot(*index);
  }
  std::optional<Slot> register_named(const Token& t, bool is_wide) {
    const auto index = numbered(t.text, is_wide ? "%rd" : "%r");
    if (!index || *index >= uint64_t(kMaxRegisters)) return {};
    if (is_wide && *index % 2) tokens_.fail(t, "an even register: a pair is named by its low half");
    return Slot(*index);
  }
  Slot destination(bool is_wide) {
    const Token t = tokens_.peek();
    const auto slot = register_named(t, is_wide);
    if (!slot)
      tokens_.fail(t, is_wide ? "a register pair, %rd0 to %rd252" : "a register, %r0 to %r254",
                   near_register(t.text, is_wide));
    tokens_.take();
    return *slot;
  }
  Slot source(bool is_wide) {
    const Token t = tokens_.peek();
    if (t.kind == Token::Kind::Word && t.text[0] == '%') {
      if (const auto slot = register_named(t, is_wide)) return tokens_.take(), *slot;
      const auto row = numbered(t.text, "%c");
      if (row && *row + (is_wide ? 2 : 1) <= program_.constants.size())
        return tokens_.take(), Slot(kConstantBank + *row);
      const Special special = find_special(t.text);
      if (!is_wide && special != Special::Count)
        return tokens_.take(), Slot(kSpecialBank + unsigned(special));
    }
    return constant(signed_literal(is_wide), is_wide);
  }
  Slot constant(uint64_t value, bool is_wide) {
    const uint32_t row = intern_constant(program_.constants, value, is_wide);
    if (row + 1 >= kSlotIndexMask) tokens_.fail(tokens_.peek(), "fewer constants: 16382 rows at most");
    return Slot(kConstantBank + row);
  }
  uint64_t signed_literal(bool is_wide) {
    const Token start = tokens_.peek();
    const bool negate = tokens_.take_if("-");
    const Token t = tokens_.peek();
    const bool is_word = t.kind == Token::Kind::Word;
    const uint64_t max = is_wide ? ~uint64_t{0} : 0xffff'ffffull;
    if (const auto bits = is_word && as_float_ ? fraction(t.text, is_wide) : std::nullopt) {
      tokens_.take();
      return negate ? *bits ^ (max / 2 + 1) : *bits;
    }
    const auto value = is_word ? number(t.text) : std::nullopt;
    if (!value || *value > (negate ? max / 2 + 1 : max))
      tokens_.fail(
          negate && !value ? t : start,
          is_wide ? "a register pair or a 64-bit number" : "a register, a special or a 32-bit number",
          is_word ? near_source(t.text, is_wide) : "");
    tokens_.take();
    return negate ? (0 - *value) & max : *value;
  }
  // Reads "[base]", "[base + n]", "[base - n]", or "[n]", whose base is the constant 0.
  void address(Inst& inst, int slot, bool is_wide) {
    tokens_.expect("[", "and an address");
    const Token first = tokens_.peek();
    const bool is_number = first.text == "-" || number(first.text).has_value();
    const uint64_t value = is_number ? signed_literal(true) : 0;
    if (is_number && tokens_.peek().text == "]") {
      inst.operand[slot] = constant(0, is_wide);
      inst.imm = displacement(first, int64_t(value));
    } else {
      inst.operand[slot] =
          is_number ? constant(value & (is_wide ? ~uint64_t{0} : 0xffff'ffffull), is_wide) : source(is_wide);
      const bool negate = tokens_.peek().text == "-";
      const Token at = tokens_.peek();
      if (tokens_.take_if("+") || tokens_.take_if("-")) {
        const int64_t n = int64_t(unsigned_number("a displacement", uint64_t{1} << 31));
        inst.imm = displacement(at, negate ? -n : n);
      }
    }
    tokens_.expect("]", "after the address");
  }
  int32_t displacement(const Token& at, int64_t value) {
    if (value != int64_t(int32_t(value))) tokens_.fail(at, "a displacement of 32 bits");
    return int32_t(value);
  }

  void resolve_labels() {
    for (const auto& [index, token] : targets_) {
      const auto it = label_at_.find(token.text);
      if (it == label_at_.end()) {
        std::vector<std::string> names;
        for (const auto& [name, at] : label_at_) names.push_back(name);
        tokens_.fail(token, "a label of this program", did_you_mean(token.text, names));
      }
      program_.code[index].imm = int32_t(it->second);
    }
  }

  Tokens tokens_;
  Program program_;
  Line line_;
  bool as_float_ = false;  // the present operand may be a fraction
  std::map<std::string, uint32_t> label_at_;
  std::vector<std::pair<uint32_t, Token>> targets_;
};

}  // namespace

Program parse(const std::string& text, const std::string& file_name) {
  return Parser(text, file_name).run();
}

}  // namespace glint::isa
