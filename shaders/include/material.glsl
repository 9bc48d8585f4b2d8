// Binding 6: one material, 32 bytes (scenes/scene.h).
// SPDX-License-Identifier: Apache-2.0
#ifndef GLINT_MATERIAL_GLSL
#define GLINT_MATERIAL_GLSL

struct Material {
  vec4 diffuse;
  int texture_index;  // negative = none
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
