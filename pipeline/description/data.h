// Makes bytes from a description: typed numbers, members by the shader's layout, generators and files.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "frontend/spirv/block_type.h"
#include "pipeline/description/description.h"

namespace glint::pipeline {

// Returns the types "u8" to "f64", and GLSL's "float", "int", "uint", "double".
const std::vector<std::string>& number_types();
uint32_t bytes_of_number(const std::string& type);
// Returns the name without aliases: "float" is "f32", and "i8" is "s8".
std::string canonical(const std::string& type);
// Says whether an integer type has the bits for a number, with or without a sign: u8 also takes -1, for 255.
bool fits(int64_t whole, const std::string& type);

// Returns the address of a buffer by name, or 0 when it is unknown. Data use it for pointers: 64-bit numbers
// that are written as a buffer's name.
using AddressOf = std::function<uint64_t(const std::string& buffer)>;

// Puts a number at `at`. Returns false when the value is not of that type, or needs more bits than that has.
bool put_number(const std::string& type, const Value& value, const AddressOf& address, std::byte* at);

// Returns the bytes of a source. `block` is the layout by which members are named, or null when there is
// none. Mistakes go to `errors`.
std::vector<std::byte> bytes_of(const DataSource& source, const frontend::BlockType* block,
                                const AddressOf& address, Diagnostics& errors);

// Draws numbers by xorshift64*, which gives the same numbers on every machine.
class RandomNumbers {
 public:
  explicit RandomNumbers(uint64_t seed) : state_(seed * 0x9e37'79b9'7f4a'7c15ull + 1) {}
  uint64_t next_bits();  // returns 53 bits
  double next_unit() { return double(next_bits()) * 0x1p-53; }

 private:
  uint64_t state_;
};

}  // namespace glint::pipeline
