// Lists the instructions of a SPIR-V module, and which of their words are ids.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "frontend/spirv/words.h"

namespace glint::frontend {

// Describes an instruction of a module. Offsets count words from its first one.
struct ParsedInst {
  spv::Op op = spv::Op::OpNop;
  size_t at = 0;  // index of its first word in the module
  uint32_t num_words = 0, type = 0, result = 0;
  std::vector<uint16_t> ids;  // offsets of the operands that are ids, without its type and result
};

// Returns the instructions of a module in order, or none when it cannot be parsed.
std::vector<ParsedInst> parsed_instructions(const Words& words);

}  // namespace glint::frontend
