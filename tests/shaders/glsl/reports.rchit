// Hands back the attributes of the hit.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "common.glsl"
#include "parts/attributes.glsl"
layout(location = 0) rayPayloadInEXT Seen seen;
void main() {
#ifdef PAIR
  seen.n = vec3(pair.x);
  seen.count = uint(pair.y);
#else
  seen.n = attributes.n;
  seen.count = attributes.count;
#endif
  seen.kind = gl_HitKindEXT;
  seen.t = gl_HitTEXT;
}
