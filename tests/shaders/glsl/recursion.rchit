// Traces again with a payload of its own.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "common.glsl"
#include "parts/path.glsl"
layout(location = 0) rayPayloadInEXT Path path;
layout(location = 1) rayPayloadEXT Path next;
void main() {
  const float early = gl_HitTEXT * 2.0;
  if (path.depth < DEPTH) {
    next.depth = path.depth + 1u;
    next.sum = 0.0;
    next.trail = 0u;
    traceRayEXT(top, gl_RayFlagsNoneEXT, 0xff, 0, 1, 0, gl_WorldRayOriginEXT + vec3(1.0, 0.0, 0.0), 0.0, gl_WorldRayDirectionEXT, 100.0, 1);
    path.sum = next.sum * 2.0 + gl_HitTEXT + float(gl_PrimitiveID) * 100.0 + early;
    path.trail = next.trail * 16u + gl_InstanceCustomIndexEXT / 100u;
  } else {
    path.sum = 1.0;
    path.trail = 15u;
  }
}
