// Writes maps of cost as files: pictures with a legend, arrays, and a list of what they are.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "base/cost_map.h"
#include "report/files/file_list.h"

namespace glint::report {

// Summarises the pixels of a map.
struct HeatSummary {
  double sum = 0, min = 0, mean = 0, max = 0;
  double p99 = 0;  // 99 of 100 pixels have no more than this.
  double top = 0;  // end of the colour scale: p99, or the largest value when p99 is 0
};
HeatSummary summary_of(const CostMap& map);

// Returns the map alone as PNG, one pixel for each (or fewer when a side has more than 2048). Colours go from
// 0 to HeatSummary::top.
std::string heat_picture(const CostMap& map);

// Returns the map as PNG, enlarged when it is small, with its name, the scale and its unit beside it.
std::string heat_png(const CostMap& map);

// Returns maps.json: {"schema", "maps": [{name, unit, doc, file, picture, width, height, sum, min, mean, p99,
// max}]}.
std::string heat_index(const std::vector<CostMap>& maps);

// Returns name and bytes of every file of a run's maps, below "heat/".
std::vector<std::pair<std::string, std::string>> heat_files(const std::vector<CostMap>& maps);

// Reads what heat_files() wrote into the directory of a run. Returns none when there are no maps. Throws
// UserError when a file is damaged.
std::vector<CostMap> read_heat(const ListedFiles& files);

}  // namespace glint::report
