// What image ops need to know of an image's type: its geometry, its texels, the operands that name a place in
// it. SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "frontend/lower/lowering.h"

namespace glint::frontend {

// As the ISA names image ops.
struct Geometry {
  std::string_view name;     // "2d", "a2d", "cube", ...
  uint32_t coordinates = 0;  // without the layer
  bool has_layers = false;
};

// The image type behind an image, a storage image or a combined one.
const Type& image_type(ModuleLowering& lowering, Id type);

// Empty, and noted as unsupported, where the ISA has none. Ops on single texels see a cube as an array of its
// faces.
std::optional<Geometry> geometry_of(ModuleLowering& lowering, Id type, bool single_texels);

// "f32", "s32" or "u32"; empty, and noted, for other types of texels.
std::string_view texel_suffix(ModuleLowering& lowering, Id type);

// Handle, layer, coordinates.
Operands integer_place(Emitter& e, const Geometry& geometry, const Operand& handle,
                       const Operands& coordinates);

// SPIR-V's image operands, from the mask at `at` on.
struct ImageOperands {
  std::optional<Id> bias, lod, offset, offsets, sample;
  std::optional<std::pair<Id, Id>> gradients;
};
ImageOperands image_operands(const Instruction& inst, size_t at);

// Four registers that the op `name` fills; noted as unsupported, and zeros, where the ISA has no such op.
Operands four_words(ModuleLowering& lowering, const std::string& name, const Operands& sources);

}  // namespace glint::frontend
