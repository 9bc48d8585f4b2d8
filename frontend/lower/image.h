// Tells image ops about the type of an image: its geometry, its texels, and the operands that name a place in
// it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "frontend/lower/lowering.h"

namespace glint::frontend {

// Names a geometry as the ISA's image ops name it.
struct Geometry {
  std::string_view name;     // "2d", "a2d", "cube", ...
  uint32_t coordinates = 0;  // number of coordinates without the layer
  bool has_layers = false;
};

// Returns the image type of an image, a storage image or a combined image.
const Type& image_type(ModuleLowering& lowering, Id type);

// Returns the geometry of an image. It is empty, and reported as unsupported, where the ISA has none. Ops on
// single texels see a cube as an array of its faces.
std::optional<Geometry> geometry_of(ModuleLowering& lowering, Id type, bool single_texels);

// Returns "f32", "s32" or "u32". It is empty, and reported as unsupported, for other types of texels.
std::string_view texel_suffix(ModuleLowering& lowering, Id type);

// Returns the handle, the layer and the coordinates.
Operands integer_place(Emitter& e, const Geometry& geometry, const Operand& handle,
                       const Operands& coordinates);

// Holds SPIR-V's image operands, which are read from the mask at operand `at` on.
struct ImageOperands {
  std::optional<Id> bias, lod, offset, offsets, sample;
  std::optional<std::pair<Id, Id>> gradients;
};
ImageOperands image_operands(const Instruction& inst, size_t at);

// Returns four registers that the op `name` fills. Where the ISA has no such op, it is reported as
// unsupported and zeros are returned.
Operands four_words(ModuleLowering& lowering, const std::string& name, const Operands& sources);

}  // namespace glint::frontend
