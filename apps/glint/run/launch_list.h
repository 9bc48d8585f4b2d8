// Runs the launches of a file one after another, each with a run directory of its own.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "apps/glint/run/launch_options.h"
#include "apps/glint/session.h"
#include "pipeline/render.h"
#include "pipeline/sampling/estimate.h"
#include "report/files/run_directory.h"

namespace glint::app {

// Returns the folders of launches with these names, in order. Characters that names of folders should not
// have become '_'.
std::vector<std::string> launch_folders(std::vector<std::string> names);

// Leaves the run directory of each launch in that of the whole run, and sums up the results.
class LaunchRecorder {
 public:
  // The directory is that of the whole run, which `info` describes.
  LaunchRecorder(const LaunchOptions& options, const pipeline::GpuParams& gpu,
                 const report::RunDirectory& directory, const report::RunInfo& info)
      : options_(options), gpu_(gpu), directory_(directory), info_(info) {}

  // Records the next launch of the list. Throws as run_recorded() does.
  void record(const std::string& name, const std::string& shader, const exec::World& world,
              const std::function<pipeline::RenderResult()>& run, exec::PrintLog* prints = nullptr);

  size_t num_begun() const { return num_begun_; }
  // The rest is of the launches that have ended: their sum, and a line for the summary about each.
  size_t num_ended() const { return lines_.size(); }
  pipeline::RenderResult& sum() { return sum_; }
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  const LaunchOptions& options_;
  const pipeline::GpuParams& gpu_;
  const report::RunDirectory& directory_;
  const report::RunInfo& info_;
  pipeline::RenderResult sum_;
  std::vector<std::string> lines_;
  size_t num_begun_ = 0;
};

struct ListedLaunch {
  std::string name, shader;
  bool warm = false;  // It begins with what the launch before it left in the caches.
  // Is called when those before it have run, once more for each further pass over the list.
  std::function<exec::World&()> prepare;
};

struct LaunchList {
  const LaunchOptions& options;
  const pipeline::RenderJob& job;         // says GPU and machine
  const report::RunDirectory& directory;  // of the whole run
  std::vector<ListedLaunch> launches;
};

struct ListResults {
  std::vector<std::string> lines;             // for the summary, about each launch
  std::vector<pipeline::Estimate> estimates;  // of a sampled run
};

// Throws UserError when launches are to be sampled and `what` has no list of them, when blocks are and it has
// one, or when it runs without time.
void check_listed(const SampleChoice& choice, bool is_list, bool timing, const std::string& what);

// Runs the launches and leaves a run directory of each in that of the run, which `info` describes. Returns
// their sum. A launch that is ended early is the last one. Throws as run_recorded() does. When launches are
// sampled (docs/sampling.md), only those that were timed have directories, are in the sum and stay in `info`.
pipeline::RenderResult run_launches(const LaunchList& list, report::RunInfo& info,
                                    const pipeline::LaunchWatch& watch, ListResults& results);

}  // namespace glint::app
