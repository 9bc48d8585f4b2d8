// Returns the radius of the sphere that was hit, by an extension that the compiler does not know.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_NV_linear_swept_spheres : require

layout(location = 0) rayPayloadInEXT float payload;

void main() { payload = gl_HitSphereRadiusNV; }
