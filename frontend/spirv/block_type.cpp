// Walks a block's type with its decorations.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/block_type.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

#include "frontend/lower/layout.h"

namespace glint::frontend {
namespace {

constexpr uint32_t kAddressBytes = 8;

std::string name_of_number(Part part) {
  switch (part) {
    case Part::Bool:
    case Part::Uint32:
      return "u32";
    case Part::Int32:
      return "s32";
    case Part::Float32:
      return "f32";
    case Part::Int64:
      return "s64";
    case Part::Uint64:
      return "u64";
    case Part::Float64:
      return "f64";
    case Part::Int8:
      return "s8";
    case Part::Uint8:
      return "u8";
    case Part::Int16:
      return "s16";
    case Part::Uint16:
      return "u16";
    case Part::Float16:
      return "f16";
  }
  return "u32";
}

class Walk {
 public:
  explicit Walk(const Module& module) : module_(module), layout_(module) {}

  BlockType of(Id id, MatrixLayout matrix) {
    const Type& type = module_.type(id);
    using Kind = Type::Kind;
    switch (type.kind) {
      case Kind::Struct:
        return of_struct(id);
      case Kind::Array:
      case Kind::RuntimeArray:
        return of_array(id, matrix);
      default:
        return of_numbers(id, matrix);
    }
  }

 private:
  BlockType of_struct(Id id) {
    const Type& type = module_.type(id);
    BlockType out;
    out.kind = BlockType::Kind::Struct;
    uint32_t next = 0;
    for (uint32_t i = 0; i < type.members.size(); ++i) {
      BlockMember member{type.members[i].name, type.members[i].offset.value_or(next),
                         of(type.members[i].type, layout_.member_matrix(id, i, {}))};
      if (member.name.empty()) member.name = fmt::format("member{}", i);
      next = member.offset + member.type.bytes;
      out.bytes = std::max(out.bytes, next);
      out.members.push_back(std::move(member));
    }
    return out;
  }

  BlockType of_array(Id id, MatrixLayout matrix) {
    const Type& type = module_.type(id);
    BlockType out;
    out.kind = BlockType::Kind::Array;
    out.element.push_back(of(type.element, matrix));
    out.count = type.kind == Type::Kind::Array ? type.count : 0;
    out.stride = type.array_stride ? type.array_stride : out.element[0].bytes;
    out.bytes = out.count * out.stride;
    return out;
  }

  BlockType of_numbers(Id id, MatrixLayout matrix) {
    BlockType out;
    if (module_.type(id).kind == Type::Kind::Pointer) {
      out.number = "u64";
      out.offsets = {0};
      out.bytes = kAddressBytes;
      if (!is_target_) {
        is_target_ = true;
        out.target.push_back(of(module_.type(id).element, {}));
        is_target_ = false;
      }
      return out;
    }
    out.number = "u32";
    for (const Leaf& leaf : layout_.leaves(id, matrix, 0)) {
      out.number = name_of_number(leaf.part);
      out.offsets.push_back(leaf.offset);
      out.bytes = std::max(out.bytes, leaf.offset + bytes_of(leaf.part));
    }
    return out;
  }

  const Module& module_;
  Layout layout_;
  bool is_target_ = false;
};

void describe(const BlockType& type, const std::string& name, uint32_t offset,
              std::vector<std::string>& out) {
  if (type.kind == BlockType::Kind::Struct) {
    for (const BlockMember& member : type.members)
      describe(member.type, name.empty() ? member.name : name + "." + member.name, offset + member.offset,
               out);
  } else if (type.kind == BlockType::Kind::Array) {
    const std::string of = name + (type.count ? fmt::format("[{}]", type.count) : "[]");
    describe(type.element[0], of, offset, out);
  } else {
    out.push_back(fmt::format("{}: {} x {} at {}", name, type.number, type.offsets.size(), offset));
  }
}

}  // namespace

BlockType block_type(const Module& module, Id type) {
  return Walk(module).of(type, {});
}

std::vector<std::string> describe_members(const BlockType& block) {
  std::vector<std::string> out;
  describe(block, "", 0, out);
  return out;
}

}  // namespace glint::frontend
