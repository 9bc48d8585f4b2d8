// Finds the cheapest ways down a grid by dynamic programming.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "compute/programs/programs.h"

namespace glint::compute {
namespace {

// Returns the cost of the cheapest way to each cell of the last row. A step leads down, or down and aside.
std::vector<int32_t> cheapest(const std::vector<int32_t>& wall, int32_t columns) {
  std::vector<int32_t> costs(wall.begin(), wall.begin() + columns), next(columns);
  for (size_t row = columns; row < wall.size(); row += columns) {
    for (int32_t i = 0; i < columns; ++i)
      next[i] = wall[row + i] +
                std::min({costs[std::max(i - 1, 0)], costs[i], costs[std::min(i + 1, columns - 1)]});
    std::swap(costs, next);
  }
  return costs;
}

}  // namespace

void pathfinder(Host& host, Size size) {
  const bool full = size == Size::Full;
  const int32_t columns = full ? 100'000 : 1'000, rows = full ? 100 : 20, rows_a_launch = full ? 20 : 5;
  std::vector<int32_t> wall(size_t(columns) * rows);
  for (int32_t& cell : wall) cell = int32_t(host.random.below(10));
  const auto cells = host.buffer("wall", wall);
  auto from = host.buffer("costs", std::vector<int32_t>(wall.begin(), wall.begin() + columns)),
       to = host.buffer<int32_t>("costs", columns);
  for (int32_t row = 1; row < rows; row += rows_a_launch) {
    struct {
      int32_t columns, first_row, rows;
    } const constants{columns, row, std::min(rows_a_launch, rows - row)};
    host.launch("pathfinder", {groups_of(columns, uint32_t(256 - 2 * constants.rows)), 1, 1},
                {cells, from, to}, constants);
    std::swap(from, to);
  }
  host.check("costs", from, cheapest(wall, columns));
}

}  // namespace glint::compute
