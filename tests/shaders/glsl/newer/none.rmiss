// Leaves the payload as it is.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_ray_tracing : require
#include "corners.glsl"
layout(location = 0) rayPayloadInEXT Seen seen;
void main() {}
