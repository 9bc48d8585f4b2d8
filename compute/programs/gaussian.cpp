// Solves a system of linear equations by elimination: two kernels for each pivot.
// SPDX-License-Identifier: Apache-2.0
#include "compute/programs/programs.h"

namespace glint::compute {
namespace {

void eliminate(std::vector<float>& matrix, std::vector<float>& right) {
  const size_t size = right.size();
  for (size_t pivot = 0; pivot + 1 < size; ++pivot)
    for (size_t row = pivot + 1; row < size; ++row) {
      const float multiplier = matrix[row * size + pivot] / matrix[pivot * size + pivot];
      for (size_t column = pivot; column < size; ++column)
        matrix[row * size + column] -= multiplier * matrix[pivot * size + column];
      right[row] -= multiplier * right[pivot];
    }
}

}  // namespace

void gaussian(Host& host, Size input) {
  const uint32_t size = input == Size::Full ? 256 : 16;
  std::vector<float> matrix = host.random.floats(size_t(size) * size, -1, 1),
                     right = host.random.floats(size, -1, 1);
  for (uint32_t i = 0; i < size; ++i) matrix[i * size + i] += float(size);  // no pivot is near 0
  const auto values = host.buffer("matrix", matrix), multipliers = host.buffer<float>("multipliers", size),
             side = host.buffer("right side", right);
  struct {
    uint32_t size, pivot;
  } constants{size, 0};
  for (; constants.pivot + 1 < size; ++constants.pivot) {
    const uint32_t rows = size - constants.pivot - 1;
    host.launch("gaussian_column", {groups_of(rows, 256), 1, 1}, {values, multipliers}, constants);
    host.launch("gaussian_rows", {groups_of(rows + 1, 16), groups_of(rows, 16), 1},
                {values, multipliers, side}, constants);
  }
  eliminate(matrix, right);
  host.check("matrix", values, matrix);
  host.check("right side", side, right);
}

}  // namespace glint::compute
