// Shades a wall of one of six materials, each of which is a program of its own, and sends the path on.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_GOOGLE_include_directive : require
#ifndef MATERIAL
#define MATERIAL 0  // pipeline.toml gives each wall its own.
#endif
#include "path.glsl"
layout(location = 0) rayPayloadInEXT Path path;
hitAttributeEXT vec2 weights;

const vec3 kColors[6] = vec3[](vec3(0.9, 0.4, 0.3), vec3(0.4, 0.8, 0.4), vec3(0.3, 0.5, 0.9), vec3(0.9, 0.8, 0.3),
                               vec3(0.7, 0.4, 0.8), vec3(0.8, 0.8, 0.8));

// Returns the brightness of a place. The patterns take turns of different kinds and numbers.
float pattern(vec3 place) {
  float sum = 0.0;
  const uint kind = pattern_at(place);
  if (kind == 0u) {
    for (int i = 1; i <= 8 + 4 * MATERIAL; ++i) sum += sin(float(i) * (place.x + place.y * 1.7 + place.z)) / float(i);
  } else if (kind == 1u) {
    for (int i = 1; i <= 12 + 3 * MATERIAL; ++i) sum += cos(float(i) * place.x) * cos(float(i) * place.z) / float(i);
  } else if (kind == 2u) {
    vec2 z = vec2(0.0);
    for (int i = 0; i < 16 + 2 * MATERIAL; ++i) z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) * 0.5 + place.xy * 0.3;
    sum = z.x + z.y;
  } else {
    for (int i = 0; i < 20; ++i) sum += sqrt(abs(place.x * float(i) - place.y)) * 0.02;
  }
  return 0.6 + 0.4 * clamp(sum, -1.0, 1.0);
}

void main() {
  const vec3 place = path.origin + gl_HitTEXT * path.direction;
  path.weight *= kColors[MATERIAL] * pattern(place);
  path.light += 0.02 * path.weight;
  // The walls are those of a box, so the normal is the axis along which the place is farthest out.
  const vec3 out_by = abs(place);
  const float far = max(out_by.x, max(out_by.y, out_by.z));
  const vec3 normal = -vec3(out_by.x == far, out_by.y == far, out_by.z == far) * sign(place);
  const float z = 2.0 * random01(path.random) - 1.0, turn = 6.2831853 * random01(path.random);
  const vec3 sphere = vec3(sqrt(max(0.0, 1.0 - z * z)) * vec2(cos(turn), sin(turn)), z);
  path.origin = place + 0.001 * normal;
  path.direction = normalize(normal * 1.01 + sphere);
}
