// Elimination, first kernel of a step: the multipliers of the rows below the pivot.
// SPDX-License-Identifier: Apache-2.0
extern "C" __global__ void __block_size__((256, 1, 1))
gaussian_column(const float* matrix, float* multipliers, unsigned size, unsigned pivot) {
  const unsigned row = pivot + 1 + blockIdx.x * 256 + threadIdx.x;
  if (row < size) multipliers[row] = matrix[row * size + pivot] / matrix[pivot * size + pivot];
}
