// Uses addresses of buffers, tables of buffers, layouts and lengths.
// SPDX-License-Identifier: Apache-2.0
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 32) in;

layout(buffer_reference, buffer_reference_align = 4, scalar) buffer Node;
layout(buffer_reference, buffer_reference_align = 8, scalar) buffer Node { Node next; uint value; vec3 color; };
layout(buffer_reference, buffer_reference_align = 4, scalar) buffer Numbers { uint n[]; };
struct Inner { vec3 a; float b; mat2 m; };
layout(set = 0, binding = 0, std430) buffer Results { uint results[]; };
layout(set = 0, binding = 1, std140, row_major) uniform Uniforms { mat3 rows; Inner inner[2]; float tail[3]; };
layout(set = 0, binding = 2, std430) buffer Table { uint before; uint words[]; } tables[];
layout(set = 0, binding = 3, std140) uniform Small { vec4 v; } smalls[2];
layout(push_constant, scalar) uniform Push { Node first; Numbers numbers; uvec2 raw; };

uint at(uint word) { return gl_GlobalInvocationID.x * 16 + word; }

void main() {
  const uint id = gl_LocalInvocationID.x;
  // The list is followed for as many steps as the lane says.
  Node node = first;
  uint steps = 0;
  while (steps < id % 4 && uint64_t(node.next) != 0ul) { node = node.next; ++steps; }
  results[at(0)] = node.value;
  results[at(1)] = floatBitsToUint(node.color.z);
  node.value += 1000;  // lanes write the same value: the lowest four nodes gain once
  // Addresses are computed from integers and from pairs of words.
  Numbers there = Numbers(uint64_t(numbers) + 4ul * id);
  Numbers pair = Numbers(raw);
  results[at(2)] = there.n[1] + pair.n[id];
  results[at(3)] = floatBitsToUint((first + 1).color.z) + uint(uint64_t(first + 2) - uint64_t(first));
  Numbers chosen = (id & 1) == 0 ? numbers : there;
  results[at(4)] = chosen.n[id];
  // These are row-major matrices, arrays with strides, and columns by number.
  results[at(5)] = floatBitsToUint(rows[id % 3][id % 2]);
  results[at(6)] = floatBitsToUint(inner[id % 2].m[1][0] + inner[1].b);
  results[at(7)] = floatBitsToUint(tail[id % 3] + inner[id % 2].a.y);
  // Buffers are chosen by number.
  const uint which = nonuniformEXT(id % 3);
  results[at(8)] = tables[which].words[id % 2] + tables[which].before;
  results[at(9)] = uint(tables[which].words.length());
  results[at(10)] = uint(results.length());
  results[at(11)] = floatBitsToUint(smalls[id & 1].v.w);
  if (id < 3) tables[id].words[1] = id + 70;
}
