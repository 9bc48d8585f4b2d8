// Adds the options of `glint run` that watch a timing run, and writes the files that they leave.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "apps/glint/options/command_line.h"
#include "pipeline/render.h"
#include "report/files/run_directory.h"

namespace glint::app {

// Adds --profile, --sample, --heat, and --trace with its window and limit.
void add_observe_options(Command command, pipeline::Observation& observe);

// Throws UserError when an option that needs cycles was given for the functional machine, which has none.
void check_observation(const pipeline::Observation& observe, bool timing);

// Returns the options of `glint run` that ask for what `observe` says.
std::vector<std::string> observe_arguments(const pipeline::Observation& observe);

// Returns whether anything was asked for.
bool observes(const pipeline::Observation& observe);

// Adds an option that takes "100:200" as cycles 100 to 200. An end that is left out is the end of the run.
Option add_cycle_window(Command command, const std::string& name, const std::string& doc, Cycle& begin,
                        Cycle& end);

// Writes the files that were asked for, and removes those of an earlier run that this run does not have.
// Returns lines for the summary. What a limit has cut off is also warned of on stderr.
std::vector<std::string> write_observation(const pipeline::Observation& observe,
                                           const pipeline::RenderResult& result,
                                           const report::RunDirectory& directory);

}  // namespace glint::app
