// Cheapest way down a grid: several rows, of which a block holds its columns and a rim as wide as the rows.
// SPDX-License-Identifier: Apache-2.0
extern "C" __global__ void __block_size__((256, 1, 1))
pathfinder(const int* wall, const int* before, int* after, int columns, int first_row, int rows) {
  __shared__ int costs[2][256];
  const int local = threadIdx.x;
  const int column = blockIdx.x * (256 - 2 * rows) + local - rows;
  const bool is_inside = column >= 0 && column < columns;
  if (is_inside) costs[0][local] = before[column];
  __syncthreads();
  const int left = column == 0 ? local : local - 1, right = column == columns - 1 ? local : local + 1;
  for (int i = 0; i < rows; ++i) {
    const int from = i & 1;
    if (is_inside && local > i && local < 255 - i) {
      const int best = min(min(costs[from][left], costs[from][local]), costs[from][right]);
      costs[1 - from][local] = best + wall[(first_row + i) * columns + column];
    }
    __syncthreads();
  }
  if (is_inside && local >= rows && local < 256 - rows) after[column] = costs[rows & 1][local];
}
