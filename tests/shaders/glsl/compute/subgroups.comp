// Uses subgroup operations in all lanes, and in the lanes that took a branch.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_shuffle_relative : require
#extension GL_KHR_shader_subgroup_clustered : require
#extension GL_KHR_shader_subgroup_quad : require
#extension GL_NV_shader_subgroup_partitioned : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
#extension GL_EXT_shader_subgroup_extended_types_int64 : require
#extension GL_EXT_shader_subgroup_extended_types_float16 : require
layout(local_size_x = 64) in;
#define WORDS 56
layout(set = 0, binding = 0) buffer Results { uint results[]; };
layout(set = 0, binding = 1) buffer Inputs { uint inputs[]; };
layout(set = 0, binding = 2) uniform Which { uint lanes; };
uint put_at;
void put(uint x) { results[put_at++] = x; }
void put(bool x) { put(x ? 1u : 0u); }
void put(float x) { put(floatBitsToUint(x)); }
void put64(uint64_t x) { put(uint(x)); put(uint(x >> 32)); }

void work(uint x) {
  put(subgroupElect()); put(subgroupAll(x > 5)); put(subgroupAny(x > 250)); put(subgroupAllEqual(x & 256u));
  const uvec4 odd = subgroupBallot((x & 1) == 1);
  put(odd.x); put(odd.y | odd.z | odd.w); put(subgroupInverseBallot(odd)); put(subgroupBallotBitExtract(odd, x & 31));
  put(subgroupBallotBitCount(odd) | subgroupBallotInclusiveBitCount(odd) << 8 | subgroupBallotExclusiveBitCount(odd) << 16);
  put(subgroupBallotFindLSB(odd)); put(subgroupBallotFindMSB(odd));
  put(subgroupBroadcastFirst(x)); put(subgroupBroadcast(x, 5));
  put(subgroupAdd(x)); put(uint(subgroupMin(int(x) - 100))); put(subgroupMax(x)); put(subgroupAnd(x | 0x70u)); put(subgroupOr(x)); put(subgroupXor(x));
  put(subgroupMul(x | 1u)); put(subgroupAdd(float(x))); put(subgroupMax(float(x) - 128.0));
  put(subgroupInclusiveAdd(x)); put(subgroupExclusiveAdd(x)); put(subgroupExclusiveMin(x)); put(uint(subgroupInclusiveMax(int(x) - 128)));
  put(subgroupExclusiveMul(x | 1u)); put(subgroupInclusiveAdd(float(x)));
  put64(subgroupAdd(uint64_t(x) << 30)); put64(subgroupExclusiveAdd(uint64_t(x) << 30));
  put(float(subgroupAdd(float16_t(x & 15u)))); put(subgroupAnd(x > 3) ? 1u : 0u); put(subgroupInclusiveOr(x > 200)); put(subgroupExclusiveXor((x & 2) != 0));
  put(subgroupClusteredAdd(x, 4)); put(subgroupClusteredMax(float(x), 8)); put(subgroupClusteredMul(x | 1u, 2));
  const uvec4 part = subgroupPartitionNV(x & 3);
  put(part.x); put(subgroupPartitionedAddNV(x, part)); put(subgroupPartitionedExclusiveAddNV(float(x), part));
  put(gl_SubgroupEqMask.x ^ gl_SubgroupGeMask.x ^ gl_SubgroupLtMask.x);
}

void main() {
  const uint lane = gl_SubgroupInvocationID, x = inputs[gl_GlobalInvocationID.x];
  put_at = gl_GlobalInvocationID.x * (2 * WORDS);
  work(x);
  put_at = gl_GlobalInvocationID.x * (2 * WORDS) + 43;
  put(subgroupShuffle(x, lane ^ 3)); put(subgroupShuffleXor(float(x), 16)); put(subgroupShuffleUp(x, 1)); put(subgroupShuffleDown(x, 2));
  put(subgroupQuadBroadcast(x, 2)); put(subgroupQuadSwapHorizontal(x) + 1000 * subgroupQuadSwapVertical(x) + 1000000 * subgroupQuadSwapDiagonal(x));
  put_at = gl_GlobalInvocationID.x * (2 * WORDS) + WORDS;
  if ((lanes >> lane & 1) == 1) work(x);
  // Lanes leave this loop one by one. The sum is over the lanes that are still in it.
  uint sum = 0;
  for (uint i = 0; i <= lane % 7; ++i) sum += subgroupAdd(1u) * (i + 1);
  results[gl_GlobalInvocationID.x * (2 * WORDS) + WORDS + 45] = sum;
}
