// Writes maps of cost for the report: a small picture of each, and its numbers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "base/cost_map.h"

namespace glint::report {

// Returns [{name, unit, doc, width, height, sum, min, mean, p99, max, top, picture}]. `top` ends the colour
// scale, and `picture` is a data URI of the map alone.
nlohmann::ordered_json page_heat(const std::vector<CostMap>& maps);

// Returns the colour scale from 0 to `top`: "#rrggbb" in even steps.
nlohmann::ordered_json page_heat_scale();

}  // namespace glint::report
