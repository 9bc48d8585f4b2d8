// Traces again, whatever the depth.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require
layout(set = 0, binding = 0) uniform accelerationStructureEXT top;
layout(location = 0) rayPayloadInEXT uint tag;
void main() { traceRayEXT(top, 0, 0xff, 0u, 0u, 0u, gl_WorldRayOriginEXT, 0.0, gl_WorldRayDirectionEXT, 100.0, 0); }
