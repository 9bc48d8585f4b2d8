// Uses the older ballots and votes, the Vulkan memory model, and structs in shared memory.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_shared_memory_block : require
#extension GL_EXT_null_initializer : require
#extension GL_ARB_shader_ballot : require
#extension GL_ARB_shader_group_vote : require
#extension GL_ARB_gpu_shader_int64 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_memory_scope_semantics : require
#pragma use_vulkan_memory_model
layout(local_size_x = 64) in;
layout(binding = 1, scalar) buffer B { uint n[]; } b;
layout(binding = 2, scalar) workgroupcoherent buffer C { uint n[]; } c;
struct S { vec3 a; bool b; mat3 m; uint c[4]; };
shared S s[16]; shared uint counter = { };
void main() {
  uint i = gl_LocalInvocationID.x;
  s[i & 15].a = vec3(i); s[i & 15].b = i > 3; s[i & 15].m[i % 3][1] = 2.0; s[i & 15].c[i & 3] = i;
  atomicAdd(s[1].c[2], 3u);
  controlBarrier(gl_ScopeWorkgroup, gl_ScopeWorkgroup, gl_StorageSemanticsShared, gl_SemanticsAcquireRelease | gl_SemanticsMakeAvailable | gl_SemanticsMakeVisible);
  S t = s[(i + 1) & 15];
  uint64_t bal = ballotARB(t.b); uint first = readFirstInvocationARB(i); uint r = readInvocationARB(i, 3);
  if (allInvocationsARB(i > 2) || anyInvocationARB(t.b) || allInvocationsEqualARB(t.b)) first++;
  atomicAdd(counter, 1); memoryBarrierShared(); barrier();
  b.n[i] = uint(bal) + first + r + counter + uint(t.m[1].y) + uint(gl_SubGroupInvocationARB) + uint(gl_SubGroupEqMaskARB) + atomicLoad(c.n[i], gl_ScopeDevice, gl_StorageSemanticsBuffer, gl_SemanticsAcquire);
}
