// Computes the heat of a chip from the power of its cells, after the equations of HotSpot.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "compute/programs/programs.h"

namespace glint::compute {
namespace {

struct Chip {
  int32_t width, height, steps;
  float x_conductance, y_conductance, z_conductance, ambient, step_over_capacity;
};

// HotSpot's constants (Huang et al., "HotSpot: a compact thermal modeling methodology", TVLSI 2006): a chip
// of silicon of 16 mm x 16 mm x 0.5 mm.
Chip chip_of(int32_t cells, int32_t steps) {
  const double side = 0.016, thickness = 0.0005, conductivity = 100, heat_capacity = 1.75e6 * 0.5,
               most_power_density = 3e6, precision = 0.001, cell = side / cells;
  const double capacity = heat_capacity * thickness * cell * cell,
               slope = most_power_density / (2 * heat_capacity * thickness), step = precision / slope;
  const auto in_plane = float(2 * conductivity * thickness);  // of cells that are as wide as high
  return {cells,    cells,
          steps,    in_plane,
          in_plane, float(conductivity * cell * cell / thickness),
          80,       float(step / capacity)};
}

std::vector<float> step_of(const std::vector<float>& t, const std::vector<float>& power, const Chip& chip) {
  std::vector<float> out(t.size());
  for (int32_t y = 0; y < chip.height; ++y)
    for (int32_t x = 0; x < chip.width; ++x) {
      const auto at = [&](int32_t column, int32_t row) {
        return t[size_t(std::clamp(row, 0, chip.height - 1)) * chip.width +
                 std::clamp(column, 0, chip.width - 1)];
      };
      const float mine = at(x, y);
      const float along_y = (at(x, y - 1) + at(x, y + 1) - 2.0f * mine) * chip.y_conductance,
                  along_x = (at(x - 1, y) + at(x + 1, y) - 2.0f * mine) * chip.x_conductance,
                  up = (chip.ambient - mine) * chip.z_conductance;
      const size_t i = size_t(y) * chip.width + x;
      out[i] = mine + chip.step_over_capacity * (power[i] + along_y + along_x + up);
    }
  return out;
}

}  // namespace

void hotspot(Host& host, Size size) {
  const Chip chip = chip_of(size == Size::Full ? 512 : 64, 2);
  const size_t cells = size_t(chip.width) * chip.height;
  const std::vector<float> temperatures = host.random.floats(cells, 320, 340),
                           power = host.random.floats(cells, 0, 0.01f);
  const auto before = host.buffer("temperatures", temperatures), heat = host.buffer("power", power),
             after = host.buffer<float>("new temperatures", cells);
  const uint32_t groups = groups_of(chip.width, 16 - 2 * chip.steps);
  host.launch("hotspot", {groups, groups, 1}, {before, heat, after}, chip);
  host.check("new temperatures", after, step_of(step_of(temperatures, power, chip), power, chip));
}

}  // namespace glint::compute
