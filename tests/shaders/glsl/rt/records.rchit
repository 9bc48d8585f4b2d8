// Reads its record before and after a nested ray and a callable, which have records of their own.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "../common.glsl"
#include "seen.glsl"
layout(set = 0, binding = 0) uniform accelerationStructureEXT top;
layout(shaderRecordEXT, scalar) buffer Record { uint tag; float scale; };
layout(location = 0) rayPayloadInEXT Seen seen;
layout(location = 1) rayPayloadEXT Seen inner;
layout(location = 2) callableDataEXT uint number;
void main() {
  const uint before = tag;
  inner = Seen(0u, 0u, 0u, 0u, 0u, 0u);
  traceRayEXT(top, gl_RayFlagsSkipClosestHitShaderEXT, 0xffu, 0u, 1u, 1u, gl_WorldRayOriginEXT, 0.0, -kDown, 50.0, 1);
  number = tag;
  executeCallableEXT(3u, 2);
  seen.closest = before * 100u + tag;
  seen.again = number + inner.miss * 1000u + uint(scale);
  seen.mask = gl_CullMaskEXT;
}
