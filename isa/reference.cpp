// Writes the reference of the instruction set from the op table.
// SPDX-License-Identifier: Apache-2.0
#include "isa/reference.h"

#include <algorithm>
#include <cctype>
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

// Returns the bits of one value: small values as numbers, others in hexadecimal.
std::string bits(uint64_t value) {
  return value < 100 ? fmt::format("{}", value) : fmt::format("0x{:x}", value);
}

std::string example_text(const OpRow& row, const Example& example) {
  std::string in;
  size_t i = 0;
  for (const OperandKind kind : row.operands.view())
    if (!is_destination(kind)) in += (in.empty() ? "" : ", ") + bits(example.in[i++]);
  const bool has_two = row.operands.count > 1 && is_destination(row.operands.kind[1]);
  return fmt::format("({}) = {}{}", in, bits(example.out), has_two ? "|" + bits(example.second) : "");
}

std::string examples_text(const OpRow& row, std::string_view separator, size_t max) {
  std::string out;
  for (const Example& example : row.examples.view().first(std::min<size_t>(max, row.examples.count))) {
    if (!out.empty()) out += separator;
    out += example_text(row, example);
  }
  return out;
}

// Lists ops that PTX lacks or writes in another form, by the beginning of the name. A name that ends in a
// space must match as a whole.
struct Other {
  std::string_view begin, ptx;
};
constexpr Other kOthers[] = {
    {"rt.", ""},
    {"rq.", ""},
    {"call.sbt.", ""},
    {"ssy ", ""},
    {"join ", ""},
    {"yield ", "`nanosleep`"},
    {"ho.", ""},
    {"print", ""},
    {"add3", ""},
    {"addsub", ""},
    {"subsub", ""},
    {"addmin", ""},
    {"addmax", ""},
    {"shladd", ""},
    {"shradd", ""},
    {"rotl", ""},
    {"nmul", ""},
    {"nfma", ""},
    {"fms", ""},
    {"min3", "`min` with three operands"},
    {"max3", "`max` with three operands"},
    {"sin.f32 ", ""},
    {"cos.f32 ", ""},
    {"ex2.f32 ", ""},
    {"lg2.f32 ", ""},
    {"rsqrt.f32 ", ""},
    {"suatom.", ""},
    {"tex.compare", "`tex` with a depth operand"},
    {"tld4.compare", "`tld4` with a depth operand"},
    {"pack.b64 ", "`mov.b64 d, {a, b}`"},
    {"unpack.b64 ", "`mov.b64 {d, e}, a`"},
    {"pack.", "`mov` of a vector"},
    {"unpack.", "`mov` to a vector"},
    {"call ", "`call` without parameter lists"},
    {"add.cc", "the carry in CC"},
    {"addc", "the carry in CC"},
    {"sub.cc", "the carry in CC"},
    {"subc", "the carry in CC"},
    {"mad.lo.cc", "the carry in CC"},
    {"mad.hi.cc", "the carry in CC"},
    {"madc", "the carry in CC"},
};

std::string title_of(const Family& family) {
  std::string out(family.name);
  out[0] = char(std::toupper(out[0]));
  return out;
}

std::string time_text(const UnitTime& time) {
  return fmt::format("{}/{}", time.latency, time.interval);
}

constexpr size_t kPageExamples = 2;  // an op has up to 8 examples, and `glint isa OP` shows all of them

std::string page_row(const OpRow& row, std::span<const PresetTimes> presets) {
  const std::string operands = operand_text(row), ptx = ptx_name(row);
  std::string out =
      fmt::format("| `{}` | {} | {} | {} |", row.name, operands.empty() ? "" : "`" + operands + "`",
                  name_of(row.klass), name_of(row.unit));
  for (const PresetTimes& times : presets)
    out += fmt::format(" {} |", time_text(times.unit[size_t(row.unit)]));
  return out + fmt::format(" {} | {} | {} |\n",
                           ptx == row.name ? "same"
                           : ptx.empty()   ? "none"
                                           : ptx,
                           row.doc, examples_text(row, "; ", kPageExamples));
}

std::vector<std::string> all_names() {
  std::vector<std::string> names;
  for (const OpRow& row : op_table()) names.emplace_back(row.name);
  return names;
}

[[noreturn]] void unknown(std::string_view what, std::string_view name,
                          const std::vector<std::string>& known) {
  const std::string near = nearest(std::string(name), known);
  throw UserError({}, fmt::format("there is no {} '{}'", what, name),
                  near.empty() ? "" : "did you mean '" + near + "'?");
}

std::string one_op(const OpRow& row, std::span<const PresetTimes> presets) {
  const std::string ptx = ptx_name(row);
  std::string out = fmt::format("{} {}\n  {}\n  class {}, unit {}\n", row.name, operand_text(row), row.doc,
                                name_of(row.klass), name_of(row.unit));
  out += fmt::format("  PTX: {}\n", ptx == row.name ? "the same name"
                                    : ptx.empty()   ? "there is no such op"
                                                    : ptx);
  for (const PresetTimes& times : presets) {
    const UnitTime& t = times.unit[size_t(row.unit)];
    out += fmt::format("  {}: latency {}, interval {} cycles\n", times.preset, t.latency, t.interval);
  }
  if (row.examples.count) out += fmt::format("  {}\n", examples_text(row, "\n  ", row.examples.count));
  return out;
}

}  // namespace

std::string operand_text(const OpRow& row) {
  std::string out;
  bool after_destination = false;
  for (const OperandKind kind : row.operands.view()) {
    out += fmt::format("{}{}",
                       out.empty()                                 ? ""
                       : after_destination && is_destination(kind) ? "|"
                                                                   : ", ",
                       text_of(kind));
    after_destination = is_destination(kind);
  }
  return out;
}

std::string ptx_name(const OpRow& row) {
  const std::string whole = std::string(row.name) + " ";
  for (const Other& other : kOthers)
    if (whole.starts_with(other.begin)) return std::string(other.ptx);
  return std::string(row.name);
}

std::string page_name(std::string_view family) {
  std::string out(family);
  std::replace(out.begin(), out.end(), ' ', '_');
  return out;
}

std::string reference_index(std::span<const PresetTimes> presets) {
  std::string out =
      "# Instruction set\n\n"
      "`tools/update_golden.py` writes this page from the op table (`isa/ops/`): do not edit it. `glint isa "
      "OP` "
      "prints one op, and\n"
      "`glint isa BEGINNING` prints all ops whose names begin with the text.\n\n"
      "- A source `a` (32 bits) or `ad` (64 bits) is a register or a number. A source of 32 bits may also be "
      "a "
      "special such as\n"
      "  `%launch.x`. `%rd` is a pair of registers, and `%r|%p` are two destinations.\n"
      "- Any instruction may have a guard, `@%p1` or `@!%p1`.\n"
      "- An example gives bits: (sources) = result, or (sources) = result|second result.\n"
      "- The column PTX says `same` where PTX's op of that name has this meaning. Otherwise it says what PTX "
      "has.\n"
      "- The columns of the presets give latency/interval of the op's unit in cycles: the cycles to a "
      "dependent instruction, and\n"
      "  the cycles to the next instruction on the pipe (`[core.units.<unit>]` of the configuration). "
      "Presets "
      "with a `base` are\n"
      "  left out.\n"
      "- `docs/instructions/<preset>.csv` lists all ops of a preset.\n"
      "\n| family | ops | |\n|---|---|---|\n";
  for (const Family& family : families())
    out += fmt::format("| [{}](isa/{}.md) | {} | {} |\n", family.name, page_name(family.name), family.count,
                       family.doc);
  out += "\n| unit |";
  for (const PresetTimes& times : presets) out += fmt::format(" {} |", times.preset);
  out += "\n|---|";
  for (size_t i = 0; i < presets.size(); ++i) out += "---|";
  for (size_t unit = 0; unit < size_t(Unit::Count); ++unit) {
    out += fmt::format("\n| {} |", name_of(Unit(unit)));
    for (const PresetTimes& times : presets) out += fmt::format(" {} |", time_text(times.unit[unit]));
  }
  return out + "\n";
}

std::string reference_page(std::string_view name, std::span<const PresetTimes> presets) {
  std::vector<std::string> names;
  for (const Family& family : families()) {
    names.push_back(page_name(family.name));
    if (names.back() != name) continue;
    std::string out = fmt::format(
        "# {}\n\n{} [isa.md](../isa.md) explains how to read this page.\n\n| op | operands | class | unit |",
        title_of(family), family.doc);
    for (const PresetTimes& times : presets) out += fmt::format(" {} |", times.preset);
    out += " PTX | meaning | examples |\n|---|---|---|---|";
    for (size_t i = 0; i < presets.size(); ++i) out += "---|";
    out += "---|---|---|\n";
    for (const OpRow& row : op_table().subspan(family.first, family.count)) out += page_row(row, presets);
    return out;
  }
  unknown("family", name, names);
}

std::string list_ops() {
  std::string out;
  for (const Family& family : families()) {
    out += fmt::format("{}: {}\n", family.name, family.doc);
    for (const OpRow& row : op_table().subspan(family.first, family.count))
      out += fmt::format("  {} {}\n", row.name, operand_text(row));
  }
  return out;
}

std::string describe_op(std::string_view name, std::span<const PresetTimes> presets) {
  if (const int index = find_op(name); index >= 0) return one_op(op_table()[size_t(index)], presets);
  std::string out;
  for (const OpRow& row : op_table())
    if (row.name.starts_with(name)) out += fmt::format("{} {}\n  {}\n", row.name, operand_text(row), row.doc);
  if (out.empty() || name.empty()) unknown("op", name, all_names());
  return out;
}

std::string instruction_table(const PresetTimes& times) {
  std::string out = "op,unit,class,latency,interval\n";
  for (const OpRow& row : op_table()) {
    const UnitTime& t = times.unit[size_t(row.unit)];
    out += fmt::format("{},{},{},{},{}\n", row.name, name_of(row.unit), name_of(row.klass), t.latency,
                       t.interval);
  }
  return out;
}

}  // namespace glint::isa
