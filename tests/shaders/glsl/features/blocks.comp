// Declares blocks that overlap in the same shared memory.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_shared_memory_block : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 64) in;
layout(binding = 1) buffer B { uint n[]; } b;
shared X { vec4 v[64]; } x; shared Y { float16_t h[512]; } y;
void main() { uint i = gl_LocalInvocationID.x; x.v[i] = vec4(i); barrier(); b.n[i] = uint(float(y.h[i * 3])); }
