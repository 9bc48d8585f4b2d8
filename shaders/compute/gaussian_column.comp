// Elimination, first kernel of a step: the multipliers of the rows below the pivot.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 256) in;
layout(set = 0, binding = 0) readonly buffer Matrix { float matrix[]; };
layout(set = 0, binding = 1) writeonly buffer Multipliers { float multipliers[]; };
layout(push_constant) uniform Constants { uint size, pivot; };

void main() {
  const uint row = pivot + 1 + gl_GlobalInvocationID.x;
  if (row < size) multipliers[row] = matrix[row * size + pivot] / matrix[pivot * size + pivot];
}
