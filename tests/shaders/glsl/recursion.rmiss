// Ends a path, or traces again with the payload that it was given.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "common.glsl"
#include "parts/path.glsl"
layout(location = 0) rayPayloadInEXT Path path;
void main() {
  path.sum += 0.5;
  path.trail = path.trail * 16u + 14u;
#ifdef MISS_TRACES
  if (path.depth++ < DEPTH)
    traceRayEXT(top, gl_RayFlagsNoneEXT, 0xff, 0, 1, 0, gl_WorldRayOriginEXT + vec3(1.0, 0.0, 0.0), 0.0, gl_WorldRayDirectionEXT, 100.0, 0);
  path.sum += gl_WorldRayOriginEXT.x;
#endif
}
