// Reads and writes the words of a SPIR-V module: its header, the first word of an instruction, literal
// strings. Source: SPIR-V specification, 2.2.1 Instructions (literals) and 2.3 Physical Layout.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <spirv/unified1/spirv.hpp11>
#include <string>
#include <string_view>
#include <vector>

namespace glint::frontend {

using Words = std::vector<uint32_t>;

inline constexpr size_t kHeaderWords = 5, kVersionWord = 1, kBoundWord = 3;

inline spv::Op op_of(uint32_t first_word) {
  return spv::Op(first_word & 0xffff);
}

// Returns the literal string that begins at the first word. It ends at its zero byte, or with the words.
std::string text_at(std::span<const uint32_t> words);

// Returns a literal string's words, its zero byte included.
Words words_of(std::string_view text);

// Appends one instruction.
void append(Words& out, spv::Op op, std::initializer_list<uint32_t> operands, const Words& more = {});

}  // namespace glint::frontend
