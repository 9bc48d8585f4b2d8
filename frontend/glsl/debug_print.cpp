// Renames a set of extended instructions, and renumbers its one instruction.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/glsl/debug_print.h"

#include <algorithm>
#include <set>
#include <spirv/unified1/spirv.hpp11>
#include <string>

#include "frontend/spirv/words.h"

namespace glint::frontend {
namespace {

constexpr std::string_view kKnownSet = "OpenCL.std";
constexpr uint32_t kDebugPrint = 1;    // NonSemantic.DebugPrintf specification
constexpr uint32_t kKnownPrint = 184;  // OpenCL extended instruction set: printf

std::string text_of(const uint32_t* words, size_t count) {
  std::string text;
  for (size_t i = 0; i < 4 * count; ++i) {
    const char c = char(words[i / 4] >> 8 * (i % 4));
    if (c == 0) break;
    text += c;
  }
  return text;
}

void append_text(std::vector<uint32_t>& out, std::string_view text) {
  const size_t first = out.size();
  out.resize(first + text.size() / 4 + 1);
  for (size_t i = 0; i < text.size(); ++i) out[first + i / 4] |= uint32_t(uint8_t(text[i])) << 8 * (i % 4);
}

std::vector<uint32_t> renamed(const std::vector<uint32_t>& words, std::string_view from, uint32_t old_number,
                              std::string_view to, uint32_t new_number) {
  std::vector<uint32_t> out(words.begin(), words.begin() + kHeaderWords);
  std::set<uint32_t> sets;
  for (size_t i = kHeaderWords; i < words.size();) {
    const size_t length = words[i] >> 16, first = out.size();
    const spv::Op op = spv::Op(words[i] & 0xffff);
    if (op == spv::Op::OpExtInstImport && text_of(&words[i + 2], length - 2) == from) {
      sets.insert(words[i + 1]);
      out.insert(out.end(), {0, words[i + 1]});
      append_text(out, to);
      out[first] = uint32_t(out.size() - first) << 16 | uint32_t(op);
    } else {
      out.insert(out.end(), words.begin() + long(i), words.begin() + long(i + length));
      // OpExtInst has the words: result type, result, set, number of the instruction, operands.
      if (op == spv::Op::OpExtInst && sets.count(words[i + 3]) && words[i + 4] == old_number)
        out[first + 4] = new_number;
    }
    i += length;
  }
  return out;
}

}  // namespace

std::vector<uint32_t> with_known_prints(const std::vector<uint32_t>& words) {
  return renamed(words, kDebugPrintSet, kDebugPrint, kKnownSet, kKnownPrint);
}
std::vector<uint32_t> with_debug_prints(const std::vector<uint32_t>& words) {
  return renamed(words, kKnownSet, kKnownPrint, kDebugPrintSet, kDebugPrint);
}

}  // namespace glint::frontend
