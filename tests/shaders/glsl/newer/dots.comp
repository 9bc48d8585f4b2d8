// Names the instructions of dot products by their numbers, so that every compiler emits them.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_spirv_intrinsics : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 32) in;
layout(set = 0, binding = 0) buffer Results { uint results[]; };

// Capability 6016 is for vectors of all integers, 6017 for four bytes, 6018 for packed bytes, 6019 for all of these.
spirv_instruction(capabilities = [6016, 6019], id = 4450) int dot_ss(ivec3 a, ivec3 b);
spirv_instruction(capabilities = [6018, 6019], id = 4451) uint dot_uu(uint a, uint b, spirv_literal int packing);
spirv_instruction(capabilities = [6017, 6019], id = 4452) int dot_su(i8vec4 a, u8vec4 b);
spirv_instruction(capabilities = [6016, 6019], id = 4453) int dot_ss_saturated(i16vec2 a, i16vec2 b, int c);
spirv_instruction(capabilities = [6016, 6019], id = 4454) uint dot_uu_saturated(uvec2 a, uvec2 b, uint c);
spirv_instruction(capabilities = [6017, 6019], id = 4455) int dot_su_saturated(i8vec4 a, u8vec4 b, int c);

void main() {
  const uint lane = gl_LocalInvocationIndex;
  const int l = int(lane);
  results[lane] = uint(dot_ss(ivec3(0x40000000, l, 1), ivec3(4, -2, -9)));
  results[32 + lane] = dot_uu(0xff01ff80u, 0xff02ff00u | lane, 0);
  results[64 + lane] = uint(dot_su(i8vec4(-128, -1, 1, l), u8vec4(255, 255, 2, 3)));
  results[96 + lane] = uint(dot_ss_saturated(i16vec2(-3, l), i16vec2(5, 2), 100));
  results[128 + lane] = uint(dot_ss_saturated(i16vec2(-32768, l), i16vec2(32767, 1), -1073774600));
  results[160 + lane] = dot_uu_saturated(uvec2(lane, 3), uvec2(1, 1), 0xfffffff0u);
  results[192 + lane] = uint(dot_su_saturated(i8vec4(127, 1, 1, 1), u8vec4(255, 0, 0, lane), 2147451250));
}
