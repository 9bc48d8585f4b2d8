// Refuses registers and numbers whose types PTX does not allow where they stand.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "frontend/ptx/lowering.h"

namespace glint::frontend::ptx {
namespace {

// Says what an instruction wants of one of its operands, which is a name or a number.
struct OperandRule {
  const Operand* operand = nullptr;
  Type type;
  bool may_be_wider = false;
};

// Returns the types of an opcode, in order, or nothing when one of them is packed, bf16 or a float of 8 bits:
// such values lie in registers of bits.
std::optional<std::vector<Type>> fundamental_types(const std::vector<std::string>& words) {
  std::vector<Type> out;
  for (size_t i = 1; i < words.size(); ++i) {
    const auto type = type_of(words[i]);
    if (!type || type->kind == 'p') continue;
    if (words[i] != fmt::format("{}{}", type->kind, type->bits)) return {};
    out.push_back(*type);
  }
  return out;
}

void add_rule(std::vector<OperandRule>& rules, const Operand& operand, const Type& type,
              bool may_be_wider = false) {
  switch (operand.kind) {
    case Operand::Kind::Name:
    case Operand::Kind::Integer:
    case Operand::Kind::Float32:
    case Operand::Kind::Float64:
      rules.push_back({&operand, type, may_be_wider});
      break;
    case Operand::Kind::Vector:
      for (const Operand& part : operand.parts) add_rule(rules, part, type, may_be_wider);
      break;
    default:
      break;
  }
}

Type doubled(Type type) {
  return {type.kind, 2 * type.bits};
}

// Returns the rules for operands whose type follows from the words of the opcode. What has no rule here may
// be of any type.
std::vector<OperandRule> operand_rules(const Instruction& inst) {
  // All operands of these have the type of the opcode, but for predicates.
  static constexpr std::array<std::string_view, 30> kPlain{
      "add", "addc", "sub", "subc", "mul", "mad",  "madc",  "div",  "rem", "abs",
      "neg", "min",  "max", "fma",  "rcp", "sqrt", "rsqrt", "sin",  "cos", "lg2",
      "ex2", "and",  "or",  "xor",  "not", "cnot", "selp",  "setp", "sad", "prmt"};
  constexpr Type kWord{'u', 32};
  std::vector<OperandRule> rules;
  const std::string& op = inst.words[0];
  const std::vector<Operand>& operands = inst.operands;
  const auto types = fundamental_types(inst.words);
  if (!types || types->empty()) return rules;
  const Type type = types->front();
  // The fourth operand of comparisons and of selp is a predicate.
  const size_t count = op == "set" || op == "setp" || op == "selp" ? 3 : operands.size();
  // Adds a rule for each operand, with the type that `type_at` says.
  const auto each = [&](auto&& type_at, bool may_be_wider = false) {
    for (size_t i = 0; i < std::min(count, operands.size()); ++i)
      add_rule(rules, operands[i], type_at(i), may_be_wider);
  };
  if (types->size() == 2 && (op == "cvt" || op == "set")) {
    each([&](size_t i) { return (*types)[i == 0 ? 0 : 1]; }, op == "cvt");
  } else if (types->size() != 1) {
    return rules;
  } else if (op == "ld" || op == "ldu" || op == "st") {
    each([&](size_t) { return type; }, true);
  } else if (op == "shl" || op == "shr" || op == "bfe") {
    each([&](size_t i) { return i < 2 ? type : kWord; });
  } else if (op == "mov") {
    const bool has_parts = std::any_of(operands.begin(), operands.end(), [](const Operand& operand) {
      return operand.kind == Operand::Kind::Vector;
    });
    if (!has_parts) each([&](size_t) { return type; });
  } else if (op == "mbarrier") {
    // States have 64 bits, and counts, parities and hints 32.
    const bool asks = inst.words[1].ends_with("_wait") && !has_word(inst.words, "parity");
    const size_t state = asks                                  ? 2
                         : inst.words[1] == "pending_count"    ? 1
                         : inst.words[1].starts_with("arrive") ? 0
                                                               : 9;
    each([&](size_t i) { return i == state ? type : kWord; });
  } else if (op == "atom" || op == "red" || std::find(kPlain.begin(), kPlain.end(), op) != kPlain.end()) {
    const bool is_wide = has_word(inst.words, "wide");
    each([&](size_t i) { return is_wide && (i == 0 || i == 3) ? doubled(type) : type; });
  }
  return rules;
}

// Returns whether a register declared with `has` may stand where `rule` wants its type (PTX ISA, "Operand
// Type Checking" and "Operand Size Exceeding Instruction-Type Size"). The assembler in the driver of an H200
// takes and refuses the same.
bool fits(const Type& has, const OperandRule& rule) {
  const Type& wants = rule.type;
  const bool is_float = has.kind == 'f', is_integer = has.kind == 'u' || has.kind == 's';
  if (wants.kind == 'f' && is_integer) return false;
  if ((wants.kind == 'u' || wants.kind == 's') && is_float) return false;
  if (!rule.may_be_wider || (wants.kind == 'f' && is_float)) return has.bits == wants.bits;
  return has.bits >= wants.bits;
}

bool number_fits(const OperandRule& rule) {
  const bool is_integer = rule.operand->kind == Operand::Kind::Integer;
  return rule.type.kind == 'b' || (rule.type.kind == 'f') != is_integer;
}

// Returns the types of registers that `rule` lets through, for a message: ".b32, .u32 or .s32".
std::string fitting_types(const OperandRule& rule) {
  const uint32_t bits = rule.type.bits;
  const std::string own = rule.type.kind == 'f'   ? fmt::format(".b{0} or .f{0}", bits)
                          : rule.type.kind == 'b' ? fmt::format("any type of {} bits", bits)
                                                  : fmt::format(".b{0}, .u{0} or .s{0}", bits);
  return rule.may_be_wider && rule.type.kind != 'f' && bits < 64 ? own + ", or a wider one" : own;
}

}  // namespace

// Reports operands whose types PTX does not allow where they stand, which is mostly a slip.
void KernelLowering::check_types(const Instruction& inst) {
  for (const OperandRule& rule : operand_rules(inst)) {
    const Operand& o = *rule.operand;
    if (o.kind != Operand::Kind::Name) {
      if (!number_fits(rule))
        error(o.position,
              fmt::format("'{}' takes {} here", joined(inst.words),
                          rule.type.kind == 'f'
                              ? "a number with a point or the bits of one, such as 1.0 or 0f3F800000"
                              : "a whole number"));
      continue;
    }
    const Symbol* symbol = find(o.name);
    if (!symbol || symbol->kind != Symbol::Kind::Register || symbol->type.kind == 'p') continue;
    if (fits(symbol->type, rule)) continue;
    error(o.position,
          fmt::format("'{}' is a register of type .{}{}, which '{}' does not take here", o.name,
                      symbol->type.kind, symbol->type.bits, joined(inst.words)),
          fmt::format("it takes {}; cvt converts a number, and mov.b{} moves its bits", fitting_types(rule),
                      symbol->type.bits));
  }
}

}  // namespace glint::frontend::ptx
