// The layout of a buffer block as a host sees it: members by name, with offsets, strides and number types.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "frontend/spirv/module.h"

namespace glint::frontend {

struct BlockMember;

struct BlockType {
  enum class Kind : uint8_t { Numbers, Array, Struct } kind = Kind::Numbers;
  // Numbers: a scalar, vector or matrix (column after column).
  std::string number;                // "f32", "u8", "s64", "f16"; addresses are "u64"
  std::vector<uint32_t> offsets;     // bytes, one a number
  uint32_t count = 0, stride = 0;    // Array: elements (0: a runtime array) and bytes from one to the next
  uint32_t bytes = 0;                // static size; a runtime array has none
  std::vector<BlockType> element;    // Array: one
  std::vector<BlockMember> members;  // Struct
};

struct BlockMember {
  std::string name;
  uint32_t offset = 0;  // bytes
  BlockType type;
};

// Of a type with an explicit layout, usually a block's struct.
BlockType block_type(const Module& module, Id type);

// "color: f32 x 3 at 16" and so on, one line a member: for listings. Members of members are dotted.
std::vector<std::string> describe_members(const BlockType& block);

}  // namespace glint::frontend
