// Uses every atomic, on buffers, on shared memory and on texels. Old values are those of some order.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_shader_atomic_float : require
#extension GL_EXT_shader_atomic_float2 : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
#extension GL_KHR_memory_scope_semantics : require
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Words { uint u[16]; int i[4]; float f[4]; };
layout(set = 0, binding = 1) buffer Wide { uint64_t w[8]; int64_t s[2]; double d[2]; };
layout(set = 0, binding = 2) buffer Old { uint old[]; };
layout(set = 0, binding = 3, r32ui) uniform uimage2D picture;
layout(set = 0, binding = 4, r32i) uniform iimage1D line;
shared uint count;
shared int low;

void main() {
  const uint id = gl_LocalInvocationID.x;
  old[id] = atomicAdd(u[0], 3);
  atomicMin(u[1], 100 + (id * 37) % 64); atomicMax(u[2], (id * 37) % 64); atomicAnd(u[3], ~(1u << (id & 31)) | 0x80u);
  atomicOr(u[4], 1u << (id & 31)); atomicXor(u[5], id); atomicExchange(u[6], 77);
  uint seen = u[7];
  for (uint tries = 0; tries < 200; ++tries) {  // adds by compare and swap
    const uint was = atomicCompSwap(u[7], seen, seen + id);
    if (was == seen) break;
    seen = was;
  }
  atomicMin(i[0], int(id) - 20); atomicMax(i[1], int(id) - 80); atomicAdd(i[2], -int(id));
  atomicAdd(f[0], 0.5); atomicMax(f[1], float(id)); atomicMin(f[2], -float(id)); atomicExchange(f[3], 2.5);
  atomicAdd(w[0], 0x100000001ul); atomicMax(w[1], uint64_t(id) << 33); atomicMin(w[2], 1ul << 40 | id);
  atomicOr(w[3], 1ul << id); atomicAnd(w[4], ~(1ul << id)); atomicXor(w[5], uint64_t(id) << 32);
  atomicExchange(w[6], 5ul); if (id == 9) atomicCompSwap(w[7], 11ul, 12ul << 32);
  atomicMin(s[0], int64_t(id) - 90l); atomicMax(s[1], -int64_t(id)); atomicAdd(d[0], 0.25lf); atomicAdd(d[1], double(id));
  if (id == 0) { count = 5; low = 1000; }
  barrier();
  atomicAdd(count, 2); atomicMin(low, 500 - int(id));
  barrier();
  if (id == 1) { u[8] = count; u[9] = uint(low); }
  imageAtomicAdd(picture, ivec2(id & 1, 1), 2u); imageAtomicMax(picture, ivec2(2, 0), id); imageAtomicOr(picture, ivec2(3, 1), 1u << (id & 31));
  imageAtomicMin(line, 3, -int(id)); if (id == 3) { imageAtomicCompSwap(line, 1, 0, 42); imageAtomicExchange(line, 2, -7); }
  atomicStore(u[10], 9u, gl_ScopeDevice, gl_StorageSemanticsBuffer, gl_SemanticsRelease);
  if (atomicLoad(u[10], gl_ScopeDevice, gl_StorageSemanticsBuffer, gl_SemanticsAcquire) == 9u) atomicAdd(u[11], 1u);
  memoryBarrierBuffer(); groupMemoryBarrier(); memoryBarrier();
}
