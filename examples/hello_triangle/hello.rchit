// Mixes the colours of the corners by the barycentric coordinates of the hit.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require
layout(location = 0) rayPayloadInEXT vec3 color;
hitAttributeEXT vec2 at;

void main() { color = vec3(1.0 - at.x - at.y, at.x, at.y); }
