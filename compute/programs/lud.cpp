// Decomposes a matrix into a lower and an upper triangle, block of 16 x 16 by block.
// SPDX-License-Identifier: Apache-2.0
#include "compute/programs/programs.h"

namespace glint::compute {
namespace {

// Decomposes in place, column by column, without pivots. Each value loses its products in the same order as
// in the kernels.
void decompose(std::vector<float>& m, uint32_t size) {
  for (uint32_t k = 0; k < size; ++k)
    for (uint32_t i = k + 1; i < size; ++i) {
      m[i * size + k] /= m[k * size + k];
      for (uint32_t j = k + 1; j < size; ++j) m[i * size + j] -= m[i * size + k] * m[k * size + j];
    }
}

}  // namespace

void lud(Host& host, Size input) {
  const uint32_t size = input == Size::Full ? 256 : 64;
  std::vector<float> matrix = host.random.floats(size_t(size) * size, -1, 1);
  for (uint32_t i = 0; i < size; ++i) matrix[i * size + i] += float(size);  // no pivot is near 0
  const auto values = host.buffer("matrix", matrix);
  struct {
    uint32_t size, first;
  } constants{size, 0};
  for (; constants.first < size; constants.first += 16) {
    const uint32_t rest = (size - constants.first) / 16 - 1;
    host.launch("lud_diagonal", {1, 1, 1}, {values}, constants);
    if (rest == 0) break;
    host.launch("lud_perimeter", {rest, 1, 1}, {values}, constants);
    host.launch("lud_internal", {rest, rest, 1}, {values}, constants);
  }
  decompose(matrix, size);
  host.check("matrix", values, matrix);
}

}  // namespace glint::compute
