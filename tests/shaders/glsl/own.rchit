// Traces again with the payload that it was given.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "common.glsl"
#include "parts/path.glsl"
layout(location = 0) rayPayloadInEXT Path path;
hitAttributeEXT vec2 where;
void main() {
  path.trail = path.trail * 16u + gl_InstanceCustomIndexEXT / 100u;
  const uint depth = path.depth++;
  if (depth < DEPTH)
    traceRayEXT(top, gl_RayFlagsNoneEXT, 0xff, 0, 1, 0, gl_WorldRayOriginEXT + vec3(1.0, 0.0, 0.0), 0.0, gl_WorldRayDirectionEXT, 100.0, 0);
  path.sum = path.sum * 2.0 + gl_HitTEXT + where.x + float(depth) * 64.0;
}
