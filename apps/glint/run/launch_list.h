// Runs the launches of a file one after another, each with a run directory of its own.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "apps/glint/run/launch_options.h"
#include "apps/glint/session.h"
#include "pipeline/render.h"
#include "report/files/run_directory.h"

namespace glint::app {

struct ListedLaunch {
  std::string name, shader;
  bool warm = false;  // It begins with what the launch before it left in the caches.
  std::function<const exec::World&()> prepare;  // is called when those before it have run
};

struct LaunchList {
  const Session& session;
  const LaunchOptions& options;
  const pipeline::RenderJob& job;         // says GPU and machine
  const report::RunDirectory& directory;  // of the whole run
  std::vector<ListedLaunch> launches;
};

// Returns the folders of launches with these names, in order.
std::vector<std::string> launch_folders(const std::vector<std::string>& names);

// Runs the launches and leaves a run directory of each in that of the run, which `info` describes. Returns
// their sum. A launch that is ended early is the last one. Throws as run_recorded() does. `lines` gets a line
// for the summary about each launch.
pipeline::RenderResult run_launches(const LaunchList& list, const report::RunInfo& info,
                                    const pipeline::LaunchWatch& watch, std::vector<std::string>& lines);

}  // namespace glint::app
