// Finds the row of the ISA table that means the same as the words of a PTX opcode.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "frontend/ptx/syntax.h"
#include "isa/op_row.h"

namespace glint::frontend::ptx {

using Words = std::vector<std::string>;

std::string joined(const Words& words);  // {"add", "f32"} -> "add.f32"
bool has_word(const Words& words, std::string_view word);

// Returns the row of an arithmetic, comparison, selection, conversion or warp op, or -1. It tries the exact
// spelling, then the spelling with PTX's defaults filled in (add.f32 = add.rn.f32), in canonical order, and
// with types that differ only in name.
int find_row(const Words& words);

// Describes what a load, store or atomic asks for, without cache hints and scopes.
struct MemoryForm {
  std::string op;     // ld, st, atom, red
  std::string space;  // global, shared, local, const, param; empty: generic
  uint32_t vector = 1;
  Words function;         // atom, red: such as {"add", "noftz"}
  std::string type_name;  // as written
  Type type;
  bool acquires = false, releases = false;
  bool is_strong = false;  // other threads may write the place at the same time
};
std::optional<MemoryForm> memory_form(const Words& words);

// Returns the row that moves `parts` values of that type, or -1. Loads of 8 and 16 bits extend to 32 bits.
int find_access_row(const MemoryForm& form, uint32_t parts);
int find_atomic_row(const MemoryForm& form);

// Returns the name in the table that is nearest to an opcode, for messages.
std::string nearest_row(const std::string& name);

}  // namespace glint::frontend::ptx
