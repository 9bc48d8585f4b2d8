// Uses blocks: shared memory, barriers, positions of threads, and a sum by halves in each block.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_KHR_shader_subgroup_basic : require
layout(local_size_x = 16, local_size_y = 5, local_size_z = 2) in;
layout(set = 0, binding = 0) buffer Results { uint results[]; };
layout(set = 0, binding = 1) buffer Sums { uint sums[]; };
shared uint part[160];
shared bool flags[2];
shared vec4 first;

void main() {
  const uint id = gl_LocalInvocationIndex, block = gl_WorkGroupID.x + gl_WorkGroupID.y * gl_NumWorkGroups.x;
  part[id] = id * id + block;
  if (id == 0) { flags[1] = true; first = vec4(1, 2, 3, float(block)); }
  barrier();
  for (uint half_size = 128; half_size > 0; half_size /= 2) {
    if (id < half_size && id + half_size < 160) part[id] += part[id + half_size];
    barrier();
  }
  const uint base = (block * 160 + id) * 8;
  results[base] = part[0] + (flags[1] ? 1 : 0) + (flags[0] ? 2 : 0) + uint(first.w) * 4;
  results[base + 1] = gl_LocalInvocationID.x | gl_LocalInvocationID.y << 8 | gl_LocalInvocationID.z << 16;
  results[base + 2] = gl_GlobalInvocationID.x | gl_GlobalInvocationID.y << 8 | gl_GlobalInvocationID.z << 16;
  results[base + 3] = gl_WorkGroupID.x | gl_WorkGroupID.y << 8 | gl_NumWorkGroups.x << 16 | gl_NumWorkGroups.y << 24;
  results[base + 4] = gl_SubgroupID | gl_NumSubgroups << 8 | gl_SubgroupSize << 16;
  results[base + 5] = gl_SubgroupInvocationID;
  results[base + 6] = gl_WorkGroupSize.x + gl_WorkGroupSize.y * 100 + gl_WorkGroupSize.z * 10000;
  if (id == 159) sums[block] = part[0];
}
