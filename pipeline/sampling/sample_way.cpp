// Orders the cells among which a sample chooses.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/sample_way.h"

#include <algorithm>
#include <numeric>

namespace glint::pipeline {

std::vector<uint32_t> begins_of(const SamplePlaces& places, std::vector<uint32_t> cells) {
  std::ranges::sort(cells);
  for (uint32_t& cell : cells) cell = places.cell_begin(cell);
  return cells;
}

std::vector<uint32_t> cells_by_cost(const SamplePlaces& places) {
  std::vector<uint32_t> cells(places.num_cells());
  std::iota(cells.begin(), cells.end(), 0u);
  std::ranges::stable_sort(cells, {}, [&](uint32_t cell) { return places.costs[cell]; });
  return cells;
}

}  // namespace glint::pipeline
