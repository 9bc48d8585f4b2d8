// Answers the ray of a probe that met a triangle, one unit below its origin.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require

layout(location = 0) rayPayloadInEXT float answer;

void main() { answer = max(gl_HitTEXT - 1.0, 0.0) * 0.001; }
