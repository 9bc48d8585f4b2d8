// Heat of a chip: two steps of a stencil of five points, of which a block holds its cells and a rim.
// SPDX-License-Identifier: Apache-2.0
#version 460
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0) readonly buffer Before { float before[]; };
layout(set = 0, binding = 1) readonly buffer Power { float power[]; };
layout(set = 0, binding = 2) writeonly buffer After { float after[]; };
layout(push_constant) uniform Constants {
  int width, height, steps;
  float x_conductance, y_conductance, z_conductance, ambient, step_over_capacity;
};
shared float cells[2][16][16];

void main() {
  const ivec2 local = ivec2(gl_LocalInvocationID.xy);
  const ivec2 at = ivec2(gl_WorkGroupID.xy) * (16 - 2 * steps) + local - steps;
  const ivec2 last = ivec2(width, height) - 1, inside = clamp(at, ivec2(0), last);
  const bool on_chip = at == inside;
  const int index = inside.y * width + inside.x;
  const float heat = power[index];
  cells[0][local.y][local.x] = before[index];
  barrier();
  // At an edge of the chip a cell takes the place of its missing neighbour.
  const int west = at.x == 0 ? local.x : local.x - 1, east = at.x == last.x ? local.x : local.x + 1;
  const int north = at.y == 0 ? local.y : local.y - 1, south = at.y == last.y ? local.y : local.y + 1;
  for (int i = 0; i < steps; ++i) {
    const int from = i & 1;
    const bool is_whole = on_chip && all(greaterThan(local, ivec2(i))) && all(lessThan(local, ivec2(15 - i)));
    if (is_whole) {
      const float mine = cells[from][local.y][local.x];
      const float y = (cells[from][north][local.x] + cells[from][south][local.x] - 2.0 * mine) * y_conductance;
      const float x = (cells[from][local.y][west] + cells[from][local.y][east] - 2.0 * mine) * x_conductance;
      const float z = (ambient - mine) * z_conductance;
      cells[1 - from][local.y][local.x] = mine + step_over_capacity * (heat + y + x + z);
    }
    barrier();
  }
  const bool is_own = all(greaterThanEqual(local, ivec2(steps))) && all(lessThan(local, ivec2(16 - steps)));
  if (on_chip && is_own) after[index] = cells[steps & 1][local.y][local.x];
}
