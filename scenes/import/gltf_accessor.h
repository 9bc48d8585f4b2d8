// Reads the elements of glTF accessors, of any stride, and checks that they lie in their buffers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace tinygltf {
class Model;
struct Accessor;
}  // namespace tinygltf

namespace glint::scenes {

// Names the part of a file that is read, for messages.
struct GltfPlace {
  const tinygltf::Model& file;
  const std::string& path;
  std::string part;                                       // "mesh 0 ('cube')"
  [[noreturn]] void fail(const std::string& what) const;  // throws UserError: "FILE: in PART: WHAT"
};

// Holds where an accessor's elements lie.
struct GltfElements {
  const unsigned char* first;
  size_t stride, count;
  template <class Value>
  Value at(size_t i, size_t bytes = sizeof(Value)) const {
    Value value{};
    std::memcpy(&value, first + i * stride, bytes);
    return value;
  }
};

// Finds elements of `bytes` bytes. Throws UserError when the accessor is sparse or leaves its buffer.
GltfElements elements_of(const GltfPlace& place, const tinygltf::Accessor& accessor, size_t bytes);

// Returns the components of all elements of accessor number `accessor`, one element after the other. Integers
// become floats by value, or as glTF 2.0, 3.6.2.2 says where the accessor is normalised. Throws UserError
// also when the elements do not have `components` components; `name` is that of the attribute, for the
// message.
std::vector<float> floats_of(const GltfPlace& place, int accessor, int components, const std::string& name);

}  // namespace glint::scenes
