// Writes the reference of the instruction set from the op table.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "isa/op_row.h"

namespace glint::isa {

// Holds one preset's times of the units, which the reference shows next to each op.
struct UnitTime {
  uint32_t latency = 0, interval = 0;  // cycles to a dependent instruction, and to the next one on the pipe
};
struct PresetTimes {
  std::string preset;
  std::array<UnitTime, size_t(Unit::Count)> unit;  // in the order of Unit
};

// Returns docs/isa.md: how to read the pages of the families, the units' times, the families.
std::string reference_index(std::span<const PresetTimes> presets);

// Returns docs/isa/<family>.md: every op of the family, one per line. Throws UserError with the nearest name
// when there is no such family.
std::string reference_page(std::string_view family, std::span<const PresetTimes> presets);
std::string page_name(std::string_view family);  // "ray tracing" becomes "ray_tracing"

// Returns every op with its operands, for a terminal.
std::string list_ops();

// Returns one op, or all ops whose names begin with `name`, for a terminal. Throws UserError with the nearest
// name when there is none.
std::string describe_op(std::string_view name, std::span<const PresetTimes> presets);

// Returns "op,unit,class,latency,interval" of each op on a line, as comma-separated values.
std::string instruction_table(const PresetTimes& times);

// Returns the operands of an op as the text writes them, such as "%r, a, ad".
std::string operand_text(const OpRow& row);

// Returns PTX's form of the op: its own name, another text where the forms differ, or "" where PTX has none.
std::string ptx_name(const OpRow& row);

}  // namespace glint::isa
