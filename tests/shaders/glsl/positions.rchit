// The corners of the triangle that was hit, by an extension that the compiler does not know.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_ray_tracing_position_fetch : require

layout(location = 0) rayPayloadInEXT vec3 payload;

void main() { payload = gl_HitTriangleVertexPositionsEXT[0]; }
