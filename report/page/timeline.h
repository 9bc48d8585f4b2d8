// Writes the warp timeline of the report, which is a bounded part of a run's trace.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "report/files/trace_files.h"

namespace glint::report {

// Returns {core, cores, begin, end, trace_begin, trace_end, cut, kinds, names, slices}. A slice is [thread,
// kind, cycles after `begin`, cycles, name] and, for rays, their number and the nodes visited.
nlohmann::ordered_json page_timeline(const Timeline& timeline);

}  // namespace glint::report
