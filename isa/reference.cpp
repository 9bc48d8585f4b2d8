// Writes the reference of the instruction set from the op table.
// SPDX-License-Identifier: Apache-2.0
#include "isa/reference.h"

#include <fmt/format.h>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "isa/paths.h"

namespace glint::isa {
namespace {

std::string_view text_of(OperandKind kind) {
  switch (kind) {
    case OperandKind::None:
      return "";
    case OperandKind::Dst32:
      return "%r";
    case OperandKind::Dst64:
      return "%rd";
    case OperandKind::DstPred:
    case OperandKind::SrcPred:
      return "%p";
    case OperandKind::Src32:
      return "a";
    case OperandKind::Src64:
      return "ad";
    case OperandKind::DstVec2:
    case OperandKind::SrcVec2:
      return "{%r, %r}";
    case OperandKind::DstVec4:
    case OperandKind::SrcVec4:
      return "{%r, %r, %r, %r}";
    case OperandKind::Address64:
      return "[%rd + imm]";
    case OperandKind::Address32:
      return "[%r + imm]";
    case OperandKind::Label:
      return "label";
  }
  return "";
}

// The bits of one value: small ones as numbers, others in hexadecimal.
std::string bits(uint64_t value) {
  return value < 100 ? fmt::format("{}", value) : fmt::format("0x{:x}", value);
}

std::string example_text(const OpRow& row, const Example& example) {
  std::string in;
  size_t i = 0;
  for (const OperandKind kind : row.operands.view())
    if (!is_destination(kind)) in += (in.empty() ? "" : ", ") + bits(example.in[i++]);
  return fmt::format("({}) = {}", in, bits(example.out));
}

std::string examples_text(const OpRow& row, std::string_view separator) {
  std::string out;
  for (const Example& example : row.examples.view()) {
    if (!out.empty()) out += separator;
    out += example_text(row, example);
  }
  return out;
}

}  // namespace

std::string operand_text(const OpRow& row) {
  std::string out;
  for (const OperandKind kind : row.operands.view())
    out += fmt::format("{}{}", out.empty() ? "" : ", ", text_of(kind));
  return out;
}

std::string reference_markdown() {
  const std::span<const OpRow> table = op_table();
  std::string out =
      "# Instruction set\n\n"
      "Written from the op table (`isa/ops/`) by `glint isa`. A source `a` (32 bits) or `ad` (64 bits) is a "
      "register, a\n"
      "number or, if it has 32 bits, a special such as `%launch.x`; `%rd` is a pair of registers. Any "
      "instruction may have\n"
      "a guard, `@%p1` or `@!%p1`. The unit names the latency in the configuration: `[core.units.<unit>]`. "
      "Examples give\n"
      "bits: (sources) = result.\n";
  for (const Family& family : families()) {
    out += fmt::format(
        "\n## {}\n\n{}\n\n| op | operands | class | unit | meaning | examples |\n|---|---|---|---|---|---|\n",
        family.name, family.doc);
    for (const OpRow& row : table.subspan(family.first, family.count)) {
      const std::string operands = operand_text(row);
      out += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", row.name,
                         operands.empty() ? "" : "`" + operands + "`", name_of(row.klass), name_of(row.unit),
                         row.doc, examples_text(row, "; "));
    }
  }
  return out;
}

std::string describe_op(std::string_view name) {
  const int index = find_op(name);
  if (index < 0) {
    std::vector<std::string> names;
    for (const OpRow& row : op_table()) names.emplace_back(row.name);
    const std::string near = nearest(std::string(name), names);
    throw UserError({}, fmt::format("no op is named '{}'", name),
                    near.empty() ? "" : "did you mean '" + near + "'?");
  }
  const OpRow& row = op_table()[size_t(index)];
  std::string out = fmt::format("{} {}\n  {}\n  class {}, unit {}\n", row.name, operand_text(row), row.doc,
                                name_of(row.klass), name_of(row.unit));
  if (row.examples.count) out += fmt::format("  {}\n", examples_text(row, "\n  "));
  return out;
}

}  // namespace glint::isa
