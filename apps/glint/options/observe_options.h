// Options of `glint run` that watch a timing run, and the files that they leave.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "apps/glint/options/command_line.h"
#include "pipeline/render.h"
#include "report/files/run_directory.h"

namespace glint::app {

// --profile, --sample, --heat and --trace with its window and limit.
void add_observe_options(Command command, pipeline::Observation& observe);

// UserError when what needs cycles was given for the functional machine, which has none.
void check_observation(const pipeline::Observation& observe, bool timing);

// Whether any of it was asked for.
bool observes(const pipeline::Observation& observe);

// An option that takes "100:200" as cycles 100 to 200; an end that is left out is the run's.
Option add_cycle_window(Command command, const std::string& name, const std::string& doc, Cycle& begin,
                        Cycle& end);

// Writes the files that were asked for, and removes those that an earlier run left and this one has not;
// returns lines for the summary. What a limit has cut off is said on stderr too.
std::vector<std::string> write_observation(const pipeline::Observation& observe,
                                           const pipeline::RenderResult& result,
                                           const report::RunDirectory& directory);

}  // namespace glint::app
