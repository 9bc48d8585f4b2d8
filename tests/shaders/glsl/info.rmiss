// Marks the payload of a ray that hit nothing.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "common.glsl"
#include "parts/info.glsl"
layout(location = 0) rayPayloadInEXT Info info;
void main() {
  info.hit = !info.hit;
  info.t = gl_RayTmaxEXT + gl_WorldRayDirectionEXT.z;
  info.flags = gl_IncomingRayFlagsEXT + 5u;
}
