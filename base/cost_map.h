// Holds what something cost for each pixel of a launch: a plain picture of numbers for every writer.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace glint {

struct CostMap {
  std::string name, unit, doc;     // for example "rays", "ray" and one sentence
  bool is_count = true;            // whole numbers, each below 2^32; otherwise any number >= 0
  uint32_t width = 0, height = 0;  // pixels: launch indices x and y
  std::vector<double> values;      // row by row, y = 0 first
};

}  // namespace glint
