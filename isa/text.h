// Defines the text of a program: PTX-like assembly that prints and parses to the identical Program.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bitset>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "isa/program.h"

namespace glint::isa {

// Returns the whole program: directives, labels, instructions, ".loc" lines. Parsing it gives an equal
// Program.
std::string to_text(const Program& program);

// Returns one instruction without a line end, for traces and messages. A label is written as "@index".
std::string to_text(const Program& program, const Inst& inst);

// Reads what to_text() writes. A whole number is bits, and "0f3F800000" and "0d3FF0000000000000" are bits of
// floats. Where an op takes a float, "1.5" and "2e-3" are the nearest float. Throws UserError
// "file:line:column: what was found, what was expected" at the first mistake. The result is well formed, but
// only verify() says whether a machine may run it.
Program parse(const std::string& text, const std::string& file_name);

// Convert between a special and its name, such as "%launch.x". An unknown name gives Special::Count.
std::string_view name_of(Special special);
Special find_special(std::string_view name);

// Convert between a stage and its name, such as "ray_generation". An unknown name gives false.
std::string_view name_of(Stage stage);
bool find_stage(std::string_view name, Stage& out);

using SpecialSet = std::bitset<size_t(kNumSpecials)>;

// Returns a set in which bit i says whether `code` reads Special(i).
SpecialSet specials_read_by(std::span<const Inst> code);

// Returns the row that holds a literal: the first row with this value (for 64 bits, the first two
// neighbours), or a new row. Text and compiler use the same rule, so text needs no constant table.
uint32_t intern_constant(std::vector<uint32_t>& rows, uint64_t value, bool is_wide);

}  // namespace glint::isa
