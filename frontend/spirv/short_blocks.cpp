// Cuts blocks word by word.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/short_blocks.h"

#include <map>
#include <span>
#include <spirv/unified1/spirv.hpp11>

#include "frontend/spirv/words.h"

namespace glint::frontend {
namespace {

using enum spv::Op;

// Finds the blocks to cut and gives each further part a label.
std::map<uint32_t, std::vector<uint32_t>> choose_parts(const Words& words, uint32_t calls_of_block,
                                                       uint32_t& bound) {
  std::map<uint32_t, std::vector<uint32_t>> parts;
  uint32_t label = 0, calls = 0;
  for (size_t at = kHeaderWords; at < words.size(); at += words[at] >> 16) {
    switch (op_of(words[at])) {
      case OpLabel:
        label = words[at + 1], calls = 0;
        break;
      case OpFunctionCall:
        if (++calls % calls_of_block == 0) parts[label].push_back(bound++);
        break;
      case OpLoopMerge:
        parts.erase(label);
        break;
      default:
        break;
    }
  }
  return parts;
}

}  // namespace

Words with_short_blocks(Words spirv, uint32_t calls_of_block) {
  uint32_t bound = spirv[kBoundWord];
  const auto parts = choose_parts(spirv, calls_of_block, bound);
  if (parts.empty()) return spirv;
  Words out(spirv.begin(), spirv.begin() + kHeaderWords);
  out[kBoundWord] = bound;
  const std::vector<uint32_t>* present = nullptr;  // the labels of the present block's further parts
  uint32_t calls = 0;
  Words line;  // the OpLine that holds; it ends with its block
  for (size_t at = kHeaderWords; at < spirv.size(); at += spirv[at] >> 16) {
    const spv::Op op = op_of(spirv[at]);
    const auto first = spirv.begin() + long(at), last = first + long(spirv[at] >> 16);
    const size_t begin = out.size();
    out.insert(out.end(), first, last);
    if (op == OpLabel) {
      const auto found = parts.find(spirv[at + 1]);
      present = found == parts.end() ? nullptr : &found->second;
      calls = 0, line.clear();
    }
    if (op == OpLine) line.assign(first, last);
    if (op == OpNoLine) line.clear();
    // A phi names the block that a value comes from, which is now the last part.
    if (op == OpPhi)
      for (size_t parent = begin + 4; parent < out.size(); parent += 2)
        if (const auto cut = parts.find(out[parent]); cut != parts.end()) out[parent] = cut->second.back();
    if (op != OpFunctionCall || !present || ++calls % calls_of_block != 0) continue;
    const uint32_t next = (*present)[calls / calls_of_block - 1];
    append(out, OpBranch, {next});
    append(out, OpLabel, {next});
    out.insert(out.end(), line.begin(), line.end());
  }
  return out;
}

}  // namespace glint::frontend
