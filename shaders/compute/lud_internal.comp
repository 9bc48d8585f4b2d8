// LU decomposition, third kernel: takes the products of the perimeter from the rest of the matrix.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0) buffer Matrix { float matrix[]; };
layout(push_constant) uniform Constants { uint size, first; };
shared float left[16][16], above[16][16];

void main() {
  const uint x = gl_LocalInvocationID.x, y = gl_LocalInvocationID.y;
  const uint column = first + 16 * (gl_WorkGroupID.x + 1) + x, row = first + 16 * (gl_WorkGroupID.y + 1) + y;
  left[y][x] = matrix[row * size + first + x];
  above[y][x] = matrix[(first + y) * size + column];
  barrier();
  float value = matrix[row * size + column];
  for (uint k = 0; k < 16; ++k) value -= left[y][k] * above[k][x];
  matrix[row * size + column] = value;
}
