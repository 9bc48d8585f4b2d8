// Gives the colour of the background.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require
layout(location = 0) rayPayloadInEXT vec3 color;

void main() { color = vec3(0.05, 0.06, 0.1); }
