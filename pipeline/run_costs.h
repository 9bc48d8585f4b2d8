// Makes maps of what each pixel of a launch cost, on either machine.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <vector>

#include "base/cost_map.h"
#include "core/cost_recorder.h"

namespace glint::pipeline {

class TimingMachine;

// Watches the machine's cores, their L1s and RT units; it is called before a timing run. The caller keeps the
// recorders and `costs` until the run is over.
std::vector<std::unique_ptr<core::CostRecorder>> record_costs(TimingMachine& machine,
                                                              core::LaunchCosts& costs);

// Returns the maps after the run. A pixel is a launch index (x, y), and the costs of several z are added up.
// Maps of cycles or misses exist only with `timing`.
std::vector<CostMap> cost_maps(const core::LaunchCosts& costs, bool timing);

}  // namespace glint::pipeline
