// Declares binding 6, the materials of 32 bytes each (scenes/scene.h).
// SPDX-License-Identifier: Apache-2.0
#ifndef GLINT_MATERIAL_GLSL
#define GLINT_MATERIAL_GLSL

struct Material {
  vec4 diffuse;
  int texture_index;  // negative: no texture
  float fuzziness;
  float refraction_index;
  uint model;
};

const uint kLambertian = 0u;
const uint kMetallic = 1u;
const uint kDielectric = 2u;
const uint kIsotropic = 3u;  // no shader implements it
const uint kDiffuseLight = 4u;

#endif
