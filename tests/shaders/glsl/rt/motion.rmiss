// Hands back the ray's time.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "../common.glsl"
#extension GL_NV_ray_tracing_motion_blur : require
layout(location = 0) rayPayloadInEXT vec2 seen;
void main() { seen = vec2(gl_CurrentRayTimeNV, 100.0); }
