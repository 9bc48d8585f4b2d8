// Maps of cost as files: pictures with a legend, arrays, a list of what they are.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "base/cost_map.h"

namespace glint::report {

// Over the pixels of a map.
struct HeatSummary {
  double sum = 0, min = 0, mean = 0, max = 0;
  double p99 = 0;  // 99 of 100 pixels have no more
  double top = 0;  // of the colour scale: p99, or the largest where that is 0
};
HeatSummary summary_of(const CostMap& map);

// The map alone, a pixel a pixel (fewer where a side has more than 2048): PNG. Colours go from 0 to
// HeatSummary::top.
std::string heat_picture(const CostMap& map);

// The map, enlarged when small, with its name, the scale and its unit beside it: PNG.
std::string heat_png(const CostMap& map);

// maps.json: {"schema", "maps": [{name, unit, doc, file, picture, width, height, sum, min, mean, p99, max}]}.
std::string heat_index(const std::vector<CostMap>& maps);

// Name and bytes of every file of a run's maps, below "heat/".
std::vector<std::pair<std::string, std::string>> heat_files(const std::vector<CostMap>& maps);

// What heat_files() wrote into a run directory; none where there are no maps. UserError where a file is
// damaged.
std::vector<CostMap> read_heat(const std::string& directory);

}  // namespace glint::report
