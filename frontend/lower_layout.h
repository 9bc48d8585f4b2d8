// How SPIR-V types become scalar parts, and where each part lies in memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <set>
#include <vector>

#include "frontend/module.h"
#include "frontend/virtual_program.h"

namespace glint::frontend {

// One scalar of a value: a 32-bit register, an even/odd pair, or a predicate (32-bit 0 or 1 in memory).
enum class Part : uint8_t { Bool, Int32, Uint32, Float32, Int64, Uint64 };

constexpr RegisterClass class_of(Part part) {
  if (part == Part::Bool) return RegisterClass::Predicate;
  return part == Part::Int64 || part == Part::Uint64 ? RegisterClass::B64 : RegisterClass::B32;
}

// Where the matrix of an access chain keeps its parts; comes from the member that holds the matrix.
struct MatrixLayout {
  uint32_t stride = 0;  // bytes from column to column (row to row if row_major); 0 = columns packed
  bool row_major = false;
};

struct Leaf {
  uint32_t offset = 0;  // bytes from the object's start
  Part part{};
};

// Buffers follow their decorations. Everything else (variables, payloads, hit attributes) has no decorated
// layout. Choice: scalars packed in order, 64-bit ones aligned to 8 bytes, so that caller and callee of a
// trace agree when their types do.
class Layout {
 public:
  explicit Layout(const Module& module) : module_(module) {}

  const std::vector<Part>& parts(Id type);
  uint32_t num_parts(Id type) { return uint32_t(parts(type).size()); }
  uint32_t first_part(Id type, uint32_t member);  // of member, element or column `member`
  Id member_type(Id type, uint32_t member) const;

  uint32_t size(Id type, MatrixLayout matrix = {});       // bytes
  uint32_t alignment(Id type);                            // bytes, of undecorated objects
  uint32_t member_offset(Id type, uint32_t member);       // bytes, Struct
  uint32_t element_stride(Id type, MatrixLayout matrix);  // bytes, arrays, Matrix, Vector
  MatrixLayout member_matrix(Id type, uint32_t member, MatrixLayout outer) const;
  std::vector<Leaf> leaves(Id type, MatrixLayout matrix, uint32_t component_stride);

  // Types met so far that no part can hold (16-bit floats, ...); they count as 32-bit words until reported.
  const std::set<Id>& unsupported() const { return unsupported_; }

 private:
  void append_leaves(Id type, MatrixLayout matrix, uint32_t component_stride, uint32_t offset,
                     std::vector<Leaf>* to);
  Part scalar(Id type);

  const Module& module_;
  std::map<Id, std::vector<Part>> parts_;
  std::set<Id> unsupported_;
};

}  // namespace glint::frontend
