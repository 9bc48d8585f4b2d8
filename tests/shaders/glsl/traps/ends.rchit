// Stores the distance of the hit.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "../common.glsl"
layout(location = 0) rayPayloadInEXT uint nothing;
void main() {
  put(6, gl_RayTmaxEXT);
  put(7, gl_HitTEXT);
}
