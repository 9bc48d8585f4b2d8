// Finds shared blocks that overlap, and renames storage classes word by word.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/shared_blocks.h"

#include <cstdint>

namespace glint::frontend {

bool has_overlapping_shared_blocks(const Words& words) {
  bool has_layout = false;
  int variables = 0;
  for (size_t i = kHeaderWords; i < words.size(); i += words[i] >> 16) {
    const spv::Op op = op_of(words[i]);
    if (op == spv::Op::OpCapability)
      has_layout |= words[i + 1] == uint32_t(spv::Capability::WorkgroupMemoryExplicitLayoutKHR);
    if (op == spv::Op::OpVariable) variables += words[i + 3] == uint32_t(spv::StorageClass::Workgroup);
  }
  return has_layout && variables > 1;
}

void move_variables(Words& words, spv::StorageClass from, spv::StorageClass to) {
  for (size_t i = kHeaderWords; i < words.size(); i += words[i] >> 16) {
    const spv::Op op = op_of(words[i]);
    const bool is_pointer = op == spv::Op::OpTypePointer || op == spv::Op::OpTypeForwardPointer;
    if (!is_pointer && op != spv::Op::OpVariable) continue;
    uint32_t& storage = words[i + (is_pointer ? 2 : 3)];
    if (storage == uint32_t(from)) storage = uint32_t(to);
  }
}

}  // namespace glint::frontend
