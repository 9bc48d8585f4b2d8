// Uses halves, bytes and tables of them in buffers and shared memory, with vectors and matrices of halves.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_shader_16bit_storage : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
#extension GL_EXT_control_flow_attributes : enable
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_EXT_shader_subgroup_extended_types_float16 : require
layout(local_size_x_id = 0, local_size_y = 1) in;
layout(constant_id = 1) const uint N = 4;
struct block_q { float16_t d; uint8_t qs[16]; };
struct q8 { f16vec2 dm; int8_t qs[32]; };
layout(binding=0) readonly buffer A { block_q a[]; };
layout(binding=0) readonly buffer A16 { uint16_t a16[]; };
layout(binding=1) readonly buffer B { f16vec4 b[]; };
layout(binding=2) writeonly buffer D { float16_t d[]; };
layout(binding=3) readonly buffer Q { q8 q[]; };
layout(push_constant) uniform P { uint ne; float scale; uint off[4]; } p;
shared float16_t tmp[64][N+1];
shared vec4 acc[32];
const int8_t kvalues[16] = {int8_t(-127), int8_t(-104), int8_t(-83), int8_t(-65), int8_t(-49), int8_t(-35), int8_t(-22), int8_t(-10), int8_t(1), int8_t(13), int8_t(25), int8_t(38), int8_t(53), int8_t(69), int8_t(89), int8_t(113)};
shared int8_t table[16];
void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (gl_LocalInvocationIndex < 16) table[gl_LocalInvocationIndex] = kvalues[gl_LocalInvocationIndex];
  barrier();
  float16_t sum = float16_t(0);
  f16vec4 v = b[i]; f16mat4 m = f16mat4(v, v, v.yxwz, v);
  [[unroll]] for (uint k = 0; k < N; ++k) {
    uint x = uint(a[i].qs[k]); sum += a[i].d * float16_t(int(x & 0xF) - 8);
    tmp[gl_LocalInvocationID.x][k] = sum;
    sum += dot(v, m[k & 3]) + float16_t(table[x & 15]);
  }
  vec4 q4 = vec4(unpack8(int(q[i].qs[0])));
  acc[gl_LocalInvocationID.x & 31] += vec4(m * v) + q4 + vec4(q[i].dm, q[i].dm);
  sum = subgroupAdd(sum); f16vec2 s2 = subgroupMax(v.xy); sum += s2.x + subgroupShuffleXor(v.z, 1);
  barrier();
  d[i + p.off[i & 3]] = sum * float16_t(p.scale) + float16_t(float(a16[i])) + max(v.x, abs(v.y)) + float16_t(exp(v.z)) + tmp[i & 63][1] + sqrt(v.w) + float16_t(fma(v.x, v.y, v.z));
}
