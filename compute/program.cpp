// Holds the table of the programs.
// SPDX-License-Identifier: Apache-2.0
#include "compute/program.h"

#include <algorithm>

#include "compute/programs/programs.h"

namespace glint::compute {
namespace {

// The times were measured once on `mobile`.
constexpr Program kPrograms[] = {
    {"bfs", "Breadth-first search of a random graph, level after level.", "4,096 nodes", "65,536 nodes", 1, 4,
     50, bfs},
    {"hotspot", "Heat of a chip by a stencil of five points, two steps a launch.", "64 x 64 cells, 2 steps",
     "512 x 512 cells, 2 steps", 1, 2, 50, hotspot},
    {"pathfinder", "Cheapest way down a grid, 20 rows a launch.", "1,000 x 20 cells", "100,000 x 100 cells",
     1, 10, 100, pathfinder},
};

}  // namespace

std::span<const Program> all_programs() {
  return kPrograms;
}

const Program* find_program(std::string_view name) {
  const auto found = std::find_if(std::begin(kPrograms), std::end(kPrograms),
                                  [&](const Program& program) { return program.name == name; });
  return found == std::end(kPrograms) ? nullptr : &*found;
}

}  // namespace glint::compute
