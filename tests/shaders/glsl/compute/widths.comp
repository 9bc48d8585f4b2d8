// Uses bytes, halves and 64-bit integers in buffers and shared memory, dot products, and copies of whole structs.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_shader_explicit_arithmetic_types : require
#extension GL_EXT_shader_16bit_storage : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 32) in;
struct Cell { uint8_t a; int16_t b; float16_t c; uint64_t d; float16_t e[3]; };
struct Deep { Cell cells[2]; mat3x2 m; bool yes; };
layout(set = 0, binding = 0, scalar) buffer Results { uint results[]; };
layout(set = 0, binding = 1, scalar) buffer Cells { Cell cells[]; };
shared Cell kept[32];
shared uint8_t bytes[64];

Deep make(Cell cell, uint id) {
  Deep deep;
  deep.cells[0] = cell; deep.cells[1] = cell; deep.cells[1].b += int16_t(id);
  deep.m = mat3x2(float(id)); deep.yes = id > 3;
  return deep;
}

void main() {
  const uint id = gl_LocalInvocationID.x;
  kept[id] = cells[id];
  bytes[id] = uint8_t(id * 9); bytes[32 + id] = uint8_t(200 - id);
  barrier();
  Cell other = kept[31 - id];
  Deep deep = make(other, id), chosen = make(kept[id], id + 1);
  if (deep.yes) chosen = deep;
  results[id * 4] = uint(other.a) | uint(uint16_t(chosen.cells[1].b)) << 8;
  results[id * 4 + 1] = floatBitsToUint(float(other.c) + float(other.e[id % 3]) + chosen.m[1][1]);
  results[id * 4 + 2] = uint(other.d >> 20) ^ uint(other.d);
  results[id * 4 + 3] = uint(bytes[id]) | uint(bytes[32 + id]) << 8;
  other.d += 1ul; other.e[id % 3] = float16_t(id);
  cells[id] = other;
}
