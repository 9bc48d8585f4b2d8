// Gives the colour of the sky.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require
layout(location = 0) rayPayloadInEXT vec3 color;

void main() { color = mix(vec3(0.9), vec3(0.4, 0.6, 0.9), 0.5 + 0.5 * gl_WorldRayDirectionEXT.y); }
