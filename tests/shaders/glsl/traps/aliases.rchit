// Declares two incoming payloads, which are the same memory.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "../common.glsl"
layout(location = 0) rayPayloadInEXT vec4 first;
layout(location = 1) rayPayloadInEXT uvec4 second;
void main() {
  const uint before = second.x;
  first.x = 1.5;
  const uint seen = second.x;
  second.y = 7u;
  first.z = uintBitsToFloat(seen) + float(floatBitsToUint(first.y));
  second.w = before;
}
