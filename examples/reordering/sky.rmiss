// Ends a path that has left the room, with the light of the sky.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_GOOGLE_include_directive : require
#include "path.glsl"
layout(location = 0) rayPayloadInEXT Path path;

void main() {
  path.light += path.weight * (1.5 + path.direction.y);
  path.goes_on = false;
}
