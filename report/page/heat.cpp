// Writes maps of cost as the report's document has them.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/heat.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "report/files/base64.h"
#include "report/files/heat_files.h"
#include "report/picture/colour_map.h"

namespace glint::report {

using Json = nlohmann::ordered_json;

Json page_heat(const std::vector<CostMap>& maps) {
  Json out = Json::array();
  for (const CostMap& map : maps) {
    const HeatSummary s = summary_of(map);
    out.push_back({{"name", map.name},
                   {"unit", map.unit},
                   {"doc", map.doc},
                   {"width", map.width},
                   {"height", map.height},
                   {"sum", s.sum},
                   {"min", s.min},
                   {"mean", s.mean},
                   {"p99", s.p99},
                   {"max", s.max},
                   {"top", s.top},
                   {"picture", "data:image/png;base64," + base64(heat_picture(map))}});
  }
  return out;
}

Json page_heat_scale() {
  constexpr int kColours = 17;
  const ColourMap colours;
  Json out = Json::array();
  for (int i = 0; i < kColours; ++i) {
    const ColourMap::Rgb& c = colours.of(double(i) / (kColours - 1));
    out.push_back(fmt::format("#{:02x}{:02x}{:02x}", c[0], c[1], c[2]));
  }
  return out;
}

}  // namespace glint::report
