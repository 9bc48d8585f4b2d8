// Hands back the record's number and the end of the ray.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "../common.glsl"
layout(location = 0) rayPayloadInEXT uvec2 found;
layout(shaderRecordEXT, scalar) buffer Record { uint tag; };
void main() { found.x = tag * 1000u + uint(gl_RayTmaxEXT); }
