// Elimination, second kernel of a step: takes the pivot's row from the rows below it, and from the right side.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0) buffer Matrix { float matrix[]; };
layout(set = 0, binding = 1) readonly buffer Multipliers { float multipliers[]; };
layout(set = 0, binding = 2) buffer Right { float right[]; };
layout(push_constant) uniform Constants { uint size, pivot; };

void main() {
  const uint row = pivot + 1 + gl_GlobalInvocationID.y, column = pivot + gl_GlobalInvocationID.x;
  if (row >= size || column >= size) return;
  matrix[row * size + column] -= multipliers[row] * matrix[pivot * size + column];
  if (column == pivot) right[row] -= multipliers[row] * right[pivot];
}
