// Heat of a chip: two steps of a stencil of five points, of which a block holds its cells and a rim.
// SPDX-License-Identifier: Apache-2.0
extern "C" __global__ void __block_size__((16, 16, 1))
hotspot(const float* before, const float* power, float* after, int width, int height, int steps, float x_conductance,
        float y_conductance, float z_conductance, float ambient, float step_over_capacity) {
  __shared__ float cells[2][16][16];
  const int x = threadIdx.x, y = threadIdx.y, own = 16 - 2 * steps;
  const int column = blockIdx.x * own + x - steps, row = blockIdx.y * own + y - steps;
  const int near_column = min(max(column, 0), width - 1), near_row = min(max(row, 0), height - 1);
  const bool on_chip = column == near_column && row == near_row;
  const int index = near_row * width + near_column;
  const float heat = power[index];
  cells[0][y][x] = before[index];
  __syncthreads();
  // At an edge of the chip a cell takes the place of its missing neighbour.
  const int west = column == 0 ? x : x - 1, east = column == width - 1 ? x : x + 1;
  const int north = row == 0 ? y : y - 1, south = row == height - 1 ? y : y + 1;
  for (int i = 0; i < steps; ++i) {
    const int from = i & 1;
    if (on_chip && min(x, y) > i && max(x, y) < 15 - i) {
      const float mine = cells[from][y][x];
      const float along_y = (cells[from][north][x] + cells[from][south][x] - 2.0f * mine) * y_conductance;
      const float along_x = (cells[from][y][west] + cells[from][y][east] - 2.0f * mine) * x_conductance;
      const float up = (ambient - mine) * z_conductance;
      cells[1 - from][y][x] = mine + step_over_capacity * (heat + along_y + along_x + up);
    }
    __syncthreads();
  }
  const bool is_own = min(x, y) >= steps && max(x, y) < 16 - steps;
  if (on_chip && is_own) after[index] = cells[steps & 1][y][x];
}
