// Notes that the primary ray hit nothing.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "common.glsl"
layout(location = 0) rayPayloadInEXT struct { vec3 position; float t; } primary;
void main() { primary.t = -1.0; primary.position = vec3(-2.0); }
