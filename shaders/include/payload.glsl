// Holds what a ray carries to its shaders and back: 48 bytes.
// SPDX-License-Identifier: Apache-2.0
#ifndef GLINT_PAYLOAD_GLSL
#define GLINT_PAYLOAD_GLSL

struct RayPayload {
  vec4 color_and_distance;  // rgb; distance in lengths of the ray's direction, negative: nothing was hit
  vec4 scatter;             // xyz: next direction, or the hit point (shadow, ambient occlusion); w: 1 if the path goes on
  vec3 normal;
  uint random_state;
};

#endif
