// Notes the geometry.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "common.glsl"
layout(location = 0) rayPayloadInEXT uvec4 log;
void main() { log.z = 50u + uint(gl_GeometryIndexEXT); }
