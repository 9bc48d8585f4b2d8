// Maps of what each pixel of a launch cost, on either machine.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <vector>

#include "base/cost_map.h"
#include "core/cost_recorder.h"

namespace glint::pipeline {

class TimingMachine;

// Before a timing run: watches its cores, their L1s and RT units. Whoever calls keeps the recorders, and
// `costs`, until the run is over.
std::vector<std::unique_ptr<core::CostRecorder>> record_costs(TimingMachine& machine,
                                                              core::LaunchCosts& costs);

// After the run. A pixel is a launch index (x, y); what several z have in common is added up. Those that
// count cycles or misses only with `timing`.
std::vector<CostMap> cost_maps(const core::LaunchCosts& costs, bool timing);

}  // namespace glint::pipeline
