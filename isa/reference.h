// The reference of the instruction set, written from the op table.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <string>
#include <string_view>

#include "isa/op_row.h"

namespace glint::isa {

// What one preset says of the units' time, for the reference to show beside each op.
struct UnitTime {
  uint32_t latency = 0, interval = 0;  // cycles: to a dependent instruction, to the next one on the pipe
};
struct PresetTimes {
  std::string preset;
  std::array<UnitTime, size_t(Unit::Count)> unit;  // in the order of Unit
};

// docs/isa.md: how to read the pages of the families, the units' times, the families.
std::string reference_index(std::span<const PresetTimes> presets);

// docs/isa/<family>.md: every op of the family, one a line. UserError with the nearest name when there is
// none.
std::string reference_page(std::string_view family, std::span<const PresetTimes> presets);
std::string page_name(std::string_view family);  // "ray tracing" -> "ray_tracing"

// Every op with its operands and sentence, for a terminal.
std::string list_ops();

// One op for a terminal, or all whose names begin so; UserError with the nearest name when there is none.
std::string describe_op(std::string_view name, std::span<const PresetTimes> presets);

// "op,unit,class,latency,interval", one op a line, as comma-separated values.
std::string instruction_table(const PresetTimes& times);

// "%r, a, ad": the operands of an op as the text writes them.
std::string operand_text(const OpRow& row);

// What PTX calls the op: its own name, other text where the forms differ, "" where PTX has none.
std::string ptx_name(const OpRow& row);

}  // namespace glint::isa
