// Answers the ray of a probe that met nothing.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require

layout(location = 0) rayPayloadInEXT float answer;

void main() { answer = gl_RayTmaxEXT - 1000.0; }
