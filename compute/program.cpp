// Holds the table of the programs.
// SPDX-License-Identifier: Apache-2.0
#include "compute/program.h"

#include <algorithm>
#include <fmt/format.h>
#include <vector>

#include "compute/programs/programs.h"

namespace glint::compute {
namespace {

// The times are processor seconds, measured once on `mobile`.
const std::vector<Program>& suite() {
  static const std::vector<Program> programs{
      {"backprop", "One step of training of a network with 16 hidden units.", "4,096 inputs", "65,536 inputs",
       0.2, 1.7, 60, backprop, true},
      {"bfs", "Breadth-first search of a random graph, level after level.", "4,096 nodes", "65,536 nodes",
       0.19, 1.5, 41, bfs, true},
      {"b+tree", "Keys and ranges of keys in a tree of nodes with 256 keys.",
       "20,000 keys, 200 queries, 120 ranges", "1,000,000 keys, 10,000 queries, 6,000 ranges", 0.16, 3.4, 65,
       btree},
      {"gaussian", "Elimination of a system of linear equations, two kernels a pivot.", "16 x 16 matrix",
       "256 x 256 matrix", 0.14, 4.8, 33, gaussian, true},
      {"hotspot", "Heat of a chip by a stencil of five points, two steps a launch.", "64 x 64 cells, 2 steps",
       "512 x 512 cells, 2 steps", 0.11, 0.7, 33, hotspot, true},
      {"kmeans", "Assignment of points with 34 features to five moving centres.",
       "2,800 points, at most 8 rounds", "494,020 points, at most 4 rounds", 0.64, 70.1, 238, kmeans},
      {"lavaMD", "Forces of particles on those of their box and of those around it.",
       "8 boxes of 100 particles", "1,000 boxes of 100 particles", 0.21, 36.3, 32, lavamd},
      {"lud", "LU decomposition in blocks of 16 x 16.", "64 x 64 matrix", "256 x 256 matrix", 0.14, 0.9, 29,
       lud},
      {"nn", "Distances of records to a place, and the five nearest.", "4,096 records", "42,764 records", 0.1,
       0.2, 25, nn, true},
      {"nw", "Alignment of two sequences, diagonal after diagonal of blocks.", "128 x 128 letters",
       "2,048 x 2,048 letters", 0.14, 6.3, 89, nw},
      {"pathfinder", "Cheapest way down a grid, several rows a launch.", "1,000 x 20 cells",
       "100,000 x 100 cells", 0.12, 3.9, 114, pathfinder, true},
      {"srad", "Speckle-reducing diffusion of an image, two kernels a step.", "128 x 128 pixels, 2 steps",
       "2,048 x 2,048 pixels, 2 steps", 0.2, 22.8, 177, srad},
      {"streamcluster", "Prices of candidates for the centres of clusters, one a launch.",
       "1,024 points in 16 dimensions", "16,384 points in 128 dimensions", 0.17, 5.5, 52, streamcluster},
  };
  return programs;
}

std::vector<Program> with_forms() {
  std::vector<Program> out;
  for (const Program& program : suite()) {
    out.push_back(program);
    if (!program.has_ptx) continue;
    Program& ptx = out.emplace_back(program);
    ptx.name += "-ptx";
    ptx.doc = fmt::format("The same as {}, with kernels in PTX.", program.name);
    ptx.form = Form::Ptx;
  }
  return out;
}

}  // namespace

std::span<const Program> all_programs() {
  static const std::vector<Program> programs = with_forms();
  return programs;
}

const Program* find_program(std::string_view name) {
  const std::span<const Program> programs = all_programs();
  const auto found =
      std::find_if(programs.begin(), programs.end(), [&](const Program& p) { return p.name == name; });
  return found == programs.end() ? nullptr : &*found;
}

}  // namespace glint::compute
