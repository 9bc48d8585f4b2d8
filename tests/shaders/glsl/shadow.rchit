// Stores where the primary ray hit.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "common.glsl"
struct Primary { vec3 position; float t; };
layout(location = 0) rayPayloadInEXT Primary primary;
void main() {
  if ((gl_IncomingRayFlagsEXT & gl_RayFlagsOpaqueEXT) == 0u) return;
  primary.t = gl_HitTEXT;
  primary.position = gl_WorldRayOriginEXT + gl_HitTEXT * gl_WorldRayDirectionEXT;
}
