// Notes that the light is visible.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : enable
layout(location = 1) rayPayloadInEXT bool lit;
void main() { lit = true; }
