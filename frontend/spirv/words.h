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

// Calls visit(op, words) for each instruction of a module, whose words begin with that of the op. It ends at
// an instruction that is longer than the module, which the validator reports.
template <class Visit>
void for_each_instruction(std::span<const uint32_t> module, const Visit& visit) {
  for (size_t at = kHeaderWords; at < module.size();) {
    const size_t length = module[at] >> 16;
    if (length == 0 || length > module.size() - at) return;
    visit(op_of(module[at]), module.subspan(at, length));
    at += length;
  }
}

// Returns the literal string that begins at the first word. It ends at its zero byte, or with the words.
std::string text_at(std::span<const uint32_t> words);

// Returns a literal string's words, its zero byte included.
Words words_of(std::string_view text);

// Appends one instruction.
void append(Words& out, spv::Op op, std::initializer_list<uint32_t> operands, const Words& more = {});

}  // namespace glint::frontend
