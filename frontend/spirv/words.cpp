// Packs and unpacks literal strings and instructions.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/words.h"

namespace glint::frontend {

std::string text_at(std::span<const uint32_t> words) {
  std::string text;
  for (size_t i = 0; i < 4 * words.size(); ++i) {
    const char c = char(words[i / 4] >> 8 * (i % 4));
    if (c == 0) break;
    text += c;
  }
  return text;
}

Words words_of(std::string_view text) {
  Words out(text.size() / 4 + 1);
  for (size_t i = 0; i < text.size(); ++i) out[i / 4] |= uint32_t(uint8_t(text[i])) << 8 * (i % 4);
  return out;
}

void append(Words& out, spv::Op op, std::initializer_list<uint32_t> operands, const Words& more) {
  out.push_back(uint32_t(1 + operands.size() + more.size()) << 16 | uint32_t(op));
  for (const uint32_t word : operands) out.push_back(word);
  for (const uint32_t word : more) out.push_back(word);
}

}  // namespace glint::frontend
