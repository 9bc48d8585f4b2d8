// Hands back distance, instance and kind of the hit.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_NV_ray_tracing : require
layout(location = 0) rayPayloadInNV uvec4 found;
void main() { found.x = uint(gl_HitTNV) + 100u * uint(gl_InstanceCustomIndexNV) + 100000u * gl_HitKindNV; }
