// Stores the end of a ray that found nothing.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "../common.glsl"
layout(location = 0) rayPayloadInEXT uint nothing;
void main() { put(6, gl_RayTmaxEXT); }
