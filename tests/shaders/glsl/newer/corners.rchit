// Hands back the corners of its triangle.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_ray_tracing_position_fetch : require
#include "corners.glsl"
layout(location = 0) rayPayloadInEXT Seen seen;
void main() {
  for (int i = 0; i < 3; ++i) seen.corners[i] = gl_HitTriangleVertexPositionsEXT[i];
}
