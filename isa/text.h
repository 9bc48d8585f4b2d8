// The text of a program: PTX-like assembly that prints and parses to the identical Program.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bitset>
#include <span>
#include <string>
#include <string_view>

#include "isa/program.h"

namespace glint::isa {

// The whole program: directives, labels, instructions, ".loc" lines. parse() of it gives an equal Program.
std::string to_text(const Program& program);

// One instruction, without a line end; a label is written as "@index". For traces and messages.
std::string to_text(const Program& program, const Inst& inst);

// Reads what to_text writes. A whole number is bits, "0f3F800000" and "0d3FF0000000000000" are bits of
// floats; where an op takes a float, "1.5" and "2e-3" are the nearest one. UserError "file:line:column: what
// was found, what was expected" at the first mistake. The result is well formed, but only verify() says
// whether a machine may run it.
Program parse(const std::string& text, const std::string& file_name);

// "%launch.x", and back; of a name that is no special: Special::Count.
std::string_view name_of(Special special);
Special find_special(std::string_view name);

// "ray_generation", and back; false if there is no such stage.
std::string_view name_of(Stage stage);
bool find_stage(std::string_view name, Stage& out);

using SpecialSet = std::bitset<size_t(kNumSpecials)>;

// Bit i is set where `code` reads Special(i).
SpecialSet specials_read_by(std::span<const Inst> code);

// The row that holds a literal: the first with this value (64 bits: the first two neighbours), or appended.
// Text and compiler use the same rule, so that text needs no constant table.
uint32_t intern_constant(std::vector<uint32_t>& rows, uint64_t value, bool is_wide);

}  // namespace glint::isa
