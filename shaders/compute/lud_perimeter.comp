// LU decomposition, second kernel: the blocks right of the diagonal one (threads 0 to 15) and below it.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 32) in;
layout(set = 0, binding = 0) buffer Matrix { float matrix[]; };
layout(push_constant) uniform Constants { uint size, first; };
shared float diagonal[16][16], right[16][16], below[16][16];

void main() {
  const uint i = gl_LocalInvocationID.x & 15, other = first + 16 * (gl_WorkGroupID.x + 1);
  const bool is_right = gl_LocalInvocationID.x < 16;
  for (uint row = is_right ? 0 : 8; row < (is_right ? 8 : 16); ++row)
    diagonal[row][i] = matrix[(first + row) * size + first + i];
  for (uint row = 0; row < 16; ++row) {
    if (is_right)
      right[row][i] = matrix[(first + row) * size + other + i];
    else
      below[row][i] = matrix[(other + row) * size + first + i];
  }
  barrier();
  if (is_right) {  // column i
    for (uint row = 1; row < 16; ++row)
      for (uint k = 0; k < row; ++k) right[row][i] -= diagonal[row][k] * right[k][i];
  } else {  // row i
    for (uint column = 0; column < 16; ++column) {
      for (uint k = 0; k < column; ++k) below[i][column] -= below[i][k] * diagonal[k][column];
      below[i][column] /= diagonal[column][column];
    }
  }
  barrier();
  for (uint row = 0; row < 16; ++row) {
    if (is_right)
      matrix[(first + row) * size + other + i] = right[row][i];
    else
      matrix[(other + row) * size + first + i] = below[row][i];
  }
}
