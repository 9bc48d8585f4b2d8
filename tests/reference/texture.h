// Computes a texture's colour at a point by the Vulkan specification's formulas in scalar code.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "scenes/scene.h"

namespace glint::reference {

// Returns the bilinear filter's mean of the four texels around (u, v): red, green, blue, alpha. There is one
// level. Wrapping and sRGB are as the texture says.
scenes::Vec4 sample(const scenes::Texture& texture, float u, float v);

}  // namespace glint::reference
