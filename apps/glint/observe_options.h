// Options of `glint run` that watch a timing run, and the files that they leave.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "pipeline/render.h"
#include "report/run_directory.h"

namespace CLI {
class App;
}

namespace glint::app {

// --profile and --sample.
void add_observe_options(CLI::App& command, pipeline::Observation& observe);

// UserError when they were given for the functional machine, which has no cycles.
void check_observation(const pipeline::Observation& observe, bool timing);

// Writes profile.csv, profile.folded and series.csv as asked for; returns lines for the summary.
std::vector<std::string> write_observation(const pipeline::Observation& observe, const pipeline::RenderResult& result,
                                           const report::RunDirectory& directory);

}  // namespace glint::app
