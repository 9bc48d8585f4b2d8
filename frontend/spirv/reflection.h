// Describes what a shader needs of its pipeline: bindings with their layouts, payload and hit-attribute
// sizes.
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
  SampledImage,  // combined with its sampler or separate; also a texel buffer
  AccelerationStructure,
  Sampler,
  Other
};

struct Binding {
  uint32_t set = 0, binding = 0;
  BindingKind kind = BindingKind::Other;
  std::string name;                             // name of the variable or of its block
  uint32_t count = 1;                           // array length; 0: runtime array
  bool is_array = false;                        // An array of one descriptor lies in a table, too.
  BlockType block{};                            // of buffers
  isa::ImageShape shape = isa::ImageShape::D2;  // of images
  std::string texel{};                          // of images: "f32", "u32", "s32"
  bool multisampled = false;                    // of images
  // This is the format of a storage image as GLSL names it, such as "r32ui". It is empty when the shader
  // declares no format.
  std::string format{};
  bool operator==(const Binding& o) const {  // compares everything but the layouts
    return set == o.set && binding == o.binding && kind == o.kind && name == o.name && count == o.count;
  }
};

struct Reflection {
  isa::Stage stage = isa::Stage::Compute;
  std::string entry_point;
  std::vector<Binding> bindings;  // sorted by set and binding
  std::array<uint32_t, 3> local_size{1, 1, 1};
  uint32_t push_constant_bytes = 0;
  uint32_t incoming_payload_bytes = 0;  // scalars are packed, and a bool has 4 bytes
  uint32_t largest_payload_bytes = 0;   // of the payloads that the shader declares for its own traces
  // These are the scalars of the payload that the shader reads, and of each payload that it declares for its
  // own traces. Each scalar is written as a letter (f float, i integer, b bool) and a digit (its bytes).
  std::string incoming_payload;
  std::vector<std::string> handed_payloads;
  uint32_t attribute_bytes = 0;
  BlockType push_constants, shader_record;  // without members when the shader has none
};

// Reflects one module before or after simplification. Before it, names and unused bindings are still present.
// Of a module with several entry points it reflects what `entry_point` uses; an empty name means the only
// one, or "main". Throws UserError when the words are malformed or have no such entry point.
Reflection reflect(const std::vector<uint32_t>& spirv, const std::string& name,
                   const std::string& entry_point = {});

}  // namespace glint::frontend
