// What a shader asks of its pipeline: bindings with their layouts, payload and hit-attribute sizes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "frontend/spirv/block_type.h"
#include "isa/image_access.h"
#include "isa/program.h"

namespace glint::frontend {

enum class BindingKind : uint8_t {
  UniformBuffer,
  StorageBuffer,
  StorageImage,
  SampledImage,  // with its sampler; a separate one and a texel buffer too
  AccelerationStructure,
  Sampler,
  Other
};

struct Binding {
  uint32_t set = 0, binding = 0;
  BindingKind kind = BindingKind::Other;
  std::string name;                             // the variable's, or its block's
  uint32_t count = 1;                           // array length; 0 = runtime array
  BlockType block{};                            // of buffers
  isa::ImageShape shape = isa::ImageShape::D2;  // of images
  std::string texel{};                          // of images: "f32", "u32", "s32"
  bool multisampled = false;                    // of images
  std::string format{};  // of storage images, as GLSL names it: "r32ui"; empty: none is declared
  bool operator==(const Binding& o) const {  // layouts aside
    return set == o.set && binding == o.binding && kind == o.kind && name == o.name && count == o.count;
  }
};

struct Reflection {
  isa::Stage stage = isa::Stage::Compute;
  std::string entry_point;
  std::vector<Binding> bindings;  // sorted by set, binding
  std::array<uint32_t, 3> local_size{1, 1, 1};
  uint32_t push_constant_bytes = 0;
  uint32_t incoming_payload_bytes = 0;  // scalar-packed, bool as 4 bytes
  uint32_t largest_payload_bytes = 0;   // of the payloads that the shader declares for its own traces
  // Scalars of the payload that the shader reads, and of those that it declares for its own traces: a letter
  // each, f float, i integer, b bool, and its bytes as a digit.
  std::string incoming_payload;
  std::vector<std::string> handed_payloads;
  uint32_t attribute_bytes = 0;
  BlockType push_constants, shader_record;  // without members: there is none
};

// Reflects one module, before or after simplification (before: names and unused bindings are still there).
// UserError when the words are malformed or hold no entry point.
Reflection reflect(const std::vector<uint32_t>& spirv, const std::string& name);

}  // namespace glint::frontend
