// Reads through shared blocks what was stored through others, one of which is never read itself.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_shared_memory_block : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 32) in;
layout(binding = 0) buffer B { uint n[]; } b;
shared Words { uint v[64]; } words;
shared Halves { uint16_t v[128]; } halves;
shared Vectors { uvec4 v[16]; } vectors;
void main() {
  const uint i = gl_LocalInvocationID.x;
  words.v[i] = 0x10000u * (i + 1) + 7 * i;
  b.n[i] = halves.v[2 * i + 1];
  barrier();
  b.n[32 + i] = vectors.v[(i ^ 5) / 4][(i ^ 5) % 4];
  barrier();
  halves.v[2 * i] = uint16_t(9);
  b.n[64 + i] = vectors.v[i / 4][i % 4];
}
