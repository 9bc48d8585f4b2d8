// Uses hints, rotations of subgroups and dot products of bytes.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_expect_assume : require
#extension GL_EXT_maximal_reconvergence : require
#  extension GL_KHR_shader_subgroup_rotate : enable
#extension GL_EXT_integer_dot_product : require
#extension GL_EXT_nontemporal_keyword : require
layout(local_size_x = 32) in;
layout(set = 0, binding = 0) nontemporal buffer Results { uint results[]; };

[[maximally_reconverges]] void main() {
  const uint lane = gl_LocalInvocationIndex;
  assumeEXT(lane < 32u);
  uint value = expectEXT(lane > 3u, true) ? lane * 10u : 7u;
  results[lane] = subgroupRotate(value, 5);
  results[32 + lane] = subgroupClusteredRotate(lane, 3u, 8u);
  const int a = int(0x80ff7f01u), b = int(0x7f02ff03u);
  results[64 + lane] = uint(dotPacked4x8EXT(a, b));
  results[96 + lane] = dotPacked4x8EXT(uint(a), uint(b));
  results[128 + lane] = uint(dotPacked4x8EXT(a, uint(b)));
  results[160 + lane] = uint(dotPacked4x8AccSatEXT(a, b, -2147483647));
  results[192 + lane] = dotPacked4x8AccSatEXT(uint(a), uint(b), 0xffffff00u);
  results[224 + lane] = uint(dotEXT(ivec3(1, -2, 3), ivec3(lane, 5, 7)));
}
