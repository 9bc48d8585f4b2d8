// LU decomposition, first kernel of a step: factors the block on the diagonal.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 16) in;
layout(set = 0, binding = 0) buffer Matrix { float matrix[]; };
layout(push_constant) uniform Constants { uint size, first; };
shared float block[16][16];

void main() {
  const uint i = gl_LocalInvocationID.x;
  for (uint row = 0; row < 16; ++row) block[row][i] = matrix[(first + row) * size + first + i];
  barrier();
  for (uint k = 0; k < 15; ++k) {
    if (i > k) {
      block[i][k] /= block[k][k];
      for (uint j = k + 1; j < 16; ++j) block[i][j] -= block[i][k] * block[k][j];
    }
    barrier();
  }
  for (uint row = 0; row < 16; ++row) matrix[(first + row) * size + first + i] = block[row][i];
}
