// Elimination, second kernel of a step: takes the pivot's row from the rows below it, and from the right side.
// SPDX-License-Identifier: Apache-2.0
extern "C" __global__ void __block_size__((16, 16, 1))
gaussian_rows(float* matrix, const float* multipliers, float* right, unsigned size, unsigned pivot) {
  const unsigned row = pivot + 1 + blockIdx.y * 16 + threadIdx.y, column = pivot + blockIdx.x * 16 + threadIdx.x;
  if (row >= size || column >= size) return;
  matrix[row * size + column] -= multipliers[row] * matrix[pivot * size + column];
  if (column == pivot) right[row] -= multipliers[row] * right[pivot];
}
