// Hands back the end of the ray.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_NV_ray_tracing : require
layout(location = 0) rayPayloadInNV uvec4 found;
void main() { found.z = uint(gl_RayTmaxNV); }
