// Draws metrics of frames over the axis of frames.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace glint::report {

// Returns a figure with a row of bars for each of a few metrics and one bar for each frame, which leads to
// the frame's own report. `points` are those of a collection of frames (report/page/collection.h), and `runs`
// holds the run of each, in order. A frame that lacks a metric has no bar there. Returns "" when there are no
// frames.
std::string frame_bars(const nlohmann::ordered_json& points,
                       const std::vector<const nlohmann::ordered_json*>& runs,
                       const nlohmann::ordered_json& metric_docs);

}  // namespace glint::report
