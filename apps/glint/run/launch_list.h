// Runs the launches of a pipeline file one after another, each with a run directory of its own.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "apps/glint/run/launch_options.h"
#include "apps/glint/session.h"
#include "pipeline/pipeline_world.h"
#include "pipeline/render.h"
#include "report/files/run_directory.h"

namespace glint::app {

struct LaunchList {
  const Session& session;
  const LaunchOptions& options;
  const pipeline::RenderJob& job;  // says GPU and machine
  pipeline::PipelineWorld& world;
  const report::RunDirectory& directory;  // of the whole run
};

// Returns the folders of the launches, in order.
std::vector<std::string> launch_folders(const pipeline::PipelineDescription& description);

// Runs the launches and leaves a run directory of each in that of the run, which `info` describes. Returns
// their sum. A launch that is ended early is the last one. Throws as run_recorded() does. `lines` gets a line
// for the summary about each launch.
pipeline::RenderResult run_launches(const LaunchList& list, const report::RunInfo& info,
                                    const pipeline::LaunchWatch& watch, std::vector<std::string>& lines);

}  // namespace glint::app
