// Says that a ray met nothing.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require
layout(location = 0) rayPayloadInEXT float distance_to_hit;

void main() { distance_to_hit = -1.0; }
