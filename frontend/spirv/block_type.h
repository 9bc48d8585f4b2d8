// Describes the layout of a buffer block as a host sees it: members by name, with offsets, strides and number
// types.
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
  // `number` and `offsets` describe a scalar, vector or matrix. A matrix is stored column after column.
  std::string number;                // "f32", "u8", "s64", "f16"; an address is "u64"
  std::vector<uint32_t> offsets;     // byte offset of each number
  uint32_t count = 0, stride = 0;    // Array: elements (0: a runtime array) and bytes from one to the next
  uint32_t bytes = 0;                // static size; 0 for a runtime array
  std::vector<BlockType> element;    // Array: its one element type
  std::vector<BlockMember> members;  // Struct
  // What an address leads to, when it stands in the block itself: a list whose elements lead to each other
  // has no end.
  std::vector<BlockType> target;
};

struct BlockMember {
  std::string name;
  uint32_t offset = 0;  // bytes
  BlockType type;
};

// Returns the layout of a type with explicit layout decorations, usually a block's struct.
BlockType block_type(const Module& module, Id type);

// Returns one line for each member, such as "color: f32 x 3 at 16", for listings. The names of nested members
// are dotted.
std::vector<std::string> describe_members(const BlockType& block);

}  // namespace glint::frontend
