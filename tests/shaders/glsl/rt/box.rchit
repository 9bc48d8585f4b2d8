// Hands back attributes of several types.
// SPDX-License-Identifier: Apache-2.0
#version 460
#include "../common.glsl"
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#include "seen.glsl"
layout(shaderRecordEXT, scalar) buffer Record { uint tag; float scale; };
layout(location = 0) rayPayloadInEXT Seen seen;
struct Attributes {
  uint tag;
  vec3 ends;
  uint64_t wide;
  bool flag;
};
hitAttributeEXT Attributes attributes;
void main() {
  seen.closest = tag;
  seen.intersection = attributes.tag + (attributes.wide == 0x1234567890ul + uint64_t(tag) ? 100000u : 0u) + (attributes.flag ? 1000000u : 0u);
  seen.again = uint(attributes.ends[0]) * 10000u + uint(attributes.ends[1] * 100.0);
  seen.mask = uint(gl_HitTEXT * 100.0) + gl_HitKindEXT * 10000u;
}
