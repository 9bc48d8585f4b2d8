// Cheapest way down a grid: several rows, of which a block holds its columns and a rim as wide as the rows.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 256) in;
layout(set = 0, binding = 0) readonly buffer Wall { int wall[]; };
layout(set = 0, binding = 1) readonly buffer Before { int before[]; };
layout(set = 0, binding = 2) writeonly buffer After { int after[]; };
layout(push_constant) uniform Constants { int columns, first_row, rows; };
shared int costs[2][256];

void main() {
  const int local = int(gl_LocalInvocationID.x);
  const int column = int(gl_WorkGroupID.x) * (256 - 2 * rows) + local - rows;
  const bool is_inside = column >= 0 && column < columns;
  if (is_inside) costs[0][local] = before[column];
  barrier();
  const int left = column == 0 ? local : local - 1, right = column == columns - 1 ? local : local + 1;
  for (int i = 0; i < rows; ++i) {
    const int from = i & 1;
    if (is_inside && local > i && local < 255 - i) {
      const int best = min(min(costs[from][left], costs[from][local]), costs[from][right]);
      costs[1 - from][local] = best + wall[(first_row + i) * columns + column];
    }
    barrier();
  }
  if (is_inside && local >= rows && local < 256 - rows) after[column] = costs[rows & 1][local];
}
