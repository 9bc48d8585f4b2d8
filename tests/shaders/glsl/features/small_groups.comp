// Uses atomics on halves and doubles, and subgroup operations on every width.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_shader_explicit_arithmetic_types : require
#extension GL_EXT_shader_atomic_float : require
#extension GL_EXT_shader_atomic_float2 : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_clustered : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_EXT_shader_subgroup_extended_types_int8 : require
#extension GL_EXT_shader_subgroup_extended_types_int16 : require
#extension GL_EXT_shader_subgroup_extended_types_int64 : require
#extension GL_EXT_shader_subgroup_extended_types_float16 : require
layout(local_size_x = 64) in;
layout(binding = 0) buffer B { float16_t h; float f; double d; uint n[]; } b;
layout(binding = 1, r32f) uniform image2D im;
shared float16_t sh; shared float sf; shared double sd;
void main() {
  uint i = gl_LocalInvocationID.x; uint r = 0;
  atomicAdd(b.h, float16_t(1)); atomicAdd(sh, float16_t(1)); atomicMin(sf, 2.0); atomicMax(b.d, 2.0lf); atomicAdd(sd, 1.0lf);
  imageAtomicAdd(im, ivec2(i), 1.0); imageAtomicExchange(im, ivec2(i), 2.0);
  i8vec3 v8 = i8vec3(int8_t(i)); r += uint(subgroupAdd(v8).y) + uint(subgroupMin(uint8_t(i))) + uint(subgroupInclusiveMul(i16vec2(i)).y) + uint(subgroupExclusiveMax(int64_t(i))) + uint(subgroupClusteredXor(uint16_t(i), 8));
  dvec2 dv = dvec2(i); r += uint(subgroupAdd(dv).x) + uint(subgroupMax(dv.y)) + uint(subgroupClusteredMin(dv.x, 16)); bvec2 bb = bvec2(i > 2, i > 3);
  r += subgroupClusteredOr(bb, 4).x ? 1 : 0; r += subgroupBroadcast(bb, 2).y ? 1 : 0; r += subgroupAllEqual(v8) ? 1 : 0; r += subgroupAllEqual(dv) ? 1 : 0; r += uint(subgroupBroadcastFirst(f16vec3(i)).z);
  uint8_t u = uint8_t(r); u <<= uint8_t(2); u = uint8_t(u * uint8_t(3)); int64_t L = int64_t(r) << 33; L = L / 3l % 77l; r += uint(L >> 3) + u + uint(abs(L)) + uint(sign(L)) + uint(clamp(L, -3l, 9l));
  b.n[i] = r + uint(unpack32(L).x) + pack32(u16vec2(r, 2)) + uint(packFloat2x16(f16vec2(r)));
}
