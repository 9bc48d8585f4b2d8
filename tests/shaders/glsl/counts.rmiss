// Counts in an array of the payload.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : enable
layout(location = 2) rayPayloadInEXT uint counts[3];
void main() { ++counts[2]; counts[gl_LaunchIDEXT.y % 2u] += 3u; }
