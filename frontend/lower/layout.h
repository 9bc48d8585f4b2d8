// Describes how SPIR-V types become scalar parts, and where each part lies in memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "frontend/spirv/module.h"
#include "frontend/virtual_program.h"

namespace glint::frontend {

// Names the type of one scalar of a value: a 32-bit register, an even/odd pair, or a predicate (in memory, a
// 32-bit 0 or 1). A value of 8 or 16 bits lies in the low bits of a register; the bits above are 0, even for
// negative numbers.
enum class Part : uint8_t {
  Bool,
  Int32,
  Uint32,
  Float32,
  Int64,
  Uint64,
  Float64,
  Int8,
  Uint8,
  Int16,
  Uint16,
  Float16
};

// Returns the bytes of a part in memory, which are also the significant bytes of its register.
constexpr uint32_t bytes_of(Part part) {
  switch (part) {
    case Part::Int8:
    case Part::Uint8:
      return 1;
    case Part::Int16:
    case Part::Uint16:
    case Part::Float16:
      return 2;
    case Part::Bool:
    case Part::Int32:
    case Part::Uint32:
    case Part::Float32:
      return 4;
    case Part::Int64:
    case Part::Uint64:
    case Part::Float64:
      return 8;
  }
  return 4;
}

constexpr bool is_float(Part part) {
  return part == Part::Float16 || part == Part::Float32 || part == Part::Float64;
}

constexpr bool is_signed(Part part) {
  return part == Part::Int8 || part == Part::Int16 || part == Part::Int32 || part == Part::Int64;
}

constexpr RegisterClass class_of(Part part) {
  if (part == Part::Bool) return RegisterClass::Predicate;
  return bytes_of(part) == 8 ? RegisterClass::B64 : RegisterClass::B32;
}

// Describes where the matrix of an access chain keeps its parts. The member that holds the matrix gives it.
struct MatrixLayout {
  uint32_t stride = 0;  // bytes from column to column (row to row if row_major); 0: the columns are packed
  bool row_major = false;
};

struct Leaf {
  uint32_t offset = 0;  // bytes from the object's start
  Part part{};
};

// Lays out types. Buffers follow their decorations. Everything else (variables, payloads, hit attributes) has
// no decorated layout. Choice: their scalars are packed in order, each aligned to its size, so that caller
// and callee of a trace agree when their types do.
class Layout {
 public:
  explicit Layout(const Module& module) : module_(module) {}

  const std::vector<Part>& parts(Id type);
  uint32_t num_parts(Id type) { return uint32_t(parts(type).size()); }
  // Returns the number of the first part of member, element or column `member`.
  uint32_t first_part(Id type, uint32_t member);
  Id member_type(Id type, uint32_t member) const;

  uint32_t size(Id type, MatrixLayout matrix = {});       // bytes
  uint32_t alignment(Id type);                            // bytes, of objects without decorations
  uint32_t member_offset(Id type, uint32_t member);       // bytes, Struct
  uint32_t element_stride(Id type, MatrixLayout matrix);  // bytes, arrays, Matrix, Vector
  MatrixLayout member_matrix(Id type, uint32_t member, MatrixLayout outer) const;
  std::vector<Leaf> leaves(Id type, MatrixLayout matrix, uint32_t component_stride);

  // Returns whether a pointer is a value: 64 bits for a pointer to a buffer, 32 bits for one to shared
  // memory. Other pointers only name places.
  bool is_address(Id type) const;
  // Returns true for the type of a variable that is an array of buffers. A pointer to it is the address of a
  // descriptor in a table.
  bool is_array_of_blocks(Id pointee) const;

  // Returns the types met so far that no part can hold, such as floats of 128 bits. They count as 32-bit
  // words until they are reported.
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
