// Adds one of the two numbers of its record.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "../common.glsl"
#include "seen.glsl"
layout(shaderRecordEXT, scalar) buffer Record { uint tag[2]; };
layout(location = 0) rayPayloadInEXT Seen seen;
void main() {
  seen.miss += tag[gl_LaunchIDEXT.y & 1u];
  seen.mask = gl_CullMaskEXT;
}
