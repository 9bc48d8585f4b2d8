// Finds where the alpha test of the built-in any-hit shaders lets rays pass, as opacity micromaps.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>

#include "exec/image_view.h"
#include "rtunit/structure/micromaps.h"
#include "scenes/scene.h"

namespace glint::pipeline {

// Holds a texture whose alpha channel is tested. It is sampled linearly, without levels.
struct AlphaTexture {
  std::span<const uint8_t> rgba;  // 4 bytes per texel
  uint32_t width = 1, height = 1;
  exec::Wrap wrap = exec::Wrap::ClampToEdge;
};

// Holds the triangles of a model, and what their materials name.
struct AlphaTriangles {
  std::span<const scenes::Vertex> vertices;
  std::span<const uint32_t> indices;
  std::span<const scenes::Material> materials;
  std::span<const AlphaTexture> textures;
};

// Bakes the test `alpha == 0` of shaders/include/alpha_hit.glsl. A micro-triangle is transparent when all
// texels that a sample within it can mix have alpha 0, and opaque when none has. Otherwise its state is
// unknown, with 2 states what the test says at its centre. Triangles with the same texture coordinates have
// the same map.
rt::Micromaps bake_opacity(const AlphaTriangles& triangles, const rt::MicromapFormat& format);

}  // namespace glint::pipeline
