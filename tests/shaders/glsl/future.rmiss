// Asks for an extension that no compiler knows.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_GLINT_from_the_future : require

layout(location = 0) rayPayloadInEXT float payload;

void main() { payload = 1.0; }
