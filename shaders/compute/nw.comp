// Alignment of two sequences (Needleman and Wunsch): the blocks of one diagonal, each diagonal by diagonal.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 16) in;
layout(set = 0, binding = 0) buffer Scores { int scores[]; };  // with a row 0 and a column 0
layout(set = 0, binding = 1) readonly buffer Similarity { int similarity[]; };
layout(push_constant) uniform Constants { int length, penalty, diagonal, first_column; };  // in blocks
shared int block[17][17], alike[16][16];

void main() {
  const int i = int(gl_LocalInvocationID.x), width = length + 1;
  const int block_x = first_column + int(gl_WorkGroupID.x), block_y = diagonal - block_x;
  const int corner = block_y * 16 * width + block_x * 16;  // above and left of the block
  for (int row = 0; row < 16; ++row)
    alike[row][i] = similarity[(block_y * 16 + row) * length + block_x * 16 + i];
  if (i == 0) block[0][0] = scores[corner];
  block[0][i + 1] = scores[corner + i + 1];
  block[i + 1][0] = scores[corner + (i + 1) * width];
  barrier();
  for (int step = 0; step < 31; ++step) {
    const int y = step - i;
    if (y >= 0 && y < 16)
      block[y + 1][i + 1] = max(block[y][i] + alike[y][i], max(block[y + 1][i], block[y][i + 1]) - penalty);
    barrier();
  }
  for (int row = 0; row < 16; ++row) scores[corner + (row + 1) * width + i + 1] = block[row + 1][i + 1];
}
