// Hands back the names of the hit, and a weight.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "../common.glsl"
layout(location = 0) rayPayloadInEXT uvec2 found;
layout(shaderRecordEXT, scalar) buffer Record { uint tag; };
hitAttributeEXT vec2 weights;
void main() {
  found.x = gl_InstanceCustomIndexEXT * 1000u + gl_PrimitiveID * 10u + gl_GeometryIndexEXT + tag * 1000000u;
  found.y = uint(weights.x * 64.0) + 1000u * uint(gl_HitTEXT);
}
