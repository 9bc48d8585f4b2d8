// Defines the data types of an Amber script, and where the numbers of one element lie in memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exec/texture_format.h"

namespace glint::amber {

enum class Scalar : uint8_t { I8, U8, I16, U16, F16, I32, U32, F32, I64, U64, F64 };
uint32_t bytes_of(Scalar scalar);
inline bool is_float(Scalar s) {
  return s == Scalar::F16 || s == Scalar::F32 || s == Scalar::F64;
}

struct Type;
struct Member {
  std::string name;
  std::shared_ptr<const Type> type;
  std::optional<uint32_t> count;  // length, for an array
  std::optional<uint32_t> offset, array_stride, matrix_stride;
};

// A Type is a scalar, a vector (rows > 1), a matrix (columns > 1), a texel format, or a struct.
struct Type {
  Scalar scalar = Scalar::I32;
  uint32_t rows = 1, columns = 1;
  bool is_packed = false;  // of a format: three channels have no room for a fourth
  // This is the format of texels. It is set for formats, and for scalars and vectors that equal one.
  std::optional<exec::TexelFormat> format;
  std::string name;
  std::vector<Member> members;
  std::optional<uint32_t> stride;  // of a struct
  bool is_struct() const { return !members.empty(); }
};

// Returns the type of a name: "int32", "vec3<float>", "mat2x4<float>" (columns by rows), "R8G8B8A8_UNORM". It
// returns none when there is no such type. A format that simulated textures lack gives a type without
// `format`.
std::optional<Type> type_named(const std::string& name);

struct Slot {
  uint32_t offset = 0;  // bytes from the start of the element
  Scalar scalar = Scalar::I32;
};
struct Layout {
  uint32_t stride = 0;  // bytes from element to element
  std::vector<Slot> slots;
};
// Lays out a type as GLSL's std430 or std140 does, and stops after kMostNumbers slots.
inline constexpr size_t kMostNumbers = size_t{1} << 20;  // limit for a struct; more is a mistake
Layout lay_out(const Type& type, bool std140);

// Writes a number as a script writes it (decimal, 0x..., nan, inf) to `at`. Returns false when the text is
// not a number of that kind.
bool put(Scalar scalar, const std::string& text, std::byte* at);
void put_real(Scalar scalar, double value, std::byte* at);
void put_integer(Scalar scalar, int64_t value, std::byte* at);  // writes the low bits
bool parse_integer(const std::string& text, int64_t& out);      // 64 bits; unsigned values wrap
bool parse_real(const std::string& text, double& out);
double get_real(Scalar scalar, const std::byte* at);
uint64_t get_bits(Scalar scalar, const std::byte* at);  // bits of an integer, sign-extended
std::string show(Scalar scalar, const std::byte* at);

}  // namespace glint::amber
