// Runs the one launch of a pipeline, a kernel or a capsule: all of it, or a sample of its blocks.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "apps/glint/run/launch_options.h"
#include "pipeline/sampling/sampled_run.h"
#include "report/files/run_directory.h"

namespace glint::app {

// Returns what run.json says of a sample of blocks.
report::SampleInfo sample_info(const pipeline::SampleOptions& options, const pipeline::SamplePlan& plan);

class SingleLaunch {
 public:
  // Both outlive the launch. The job says GPU and machine.
  SingleLaunch(const LaunchOptions& options, const pipeline::RenderJob& job) : options_(options), job_(job) {}

  // Runs the launch, and notes in `info` what was sampled. Throws as run_world() and run_sampled() do.
  pipeline::RenderResult run(const exec::World& world, report::RunInfo& info,
                             const pipeline::LaunchWatch& watch);
  // Writes what was observed, and the batches of a sample. Returns lines for the summary.
  std::vector<std::string> keep(const pipeline::RenderResult& ended,
                                const report::RunDirectory& directory) const;
  // There are none when all of the launch was run.
  const std::vector<pipeline::Estimate>& estimates() const { return sampled_.estimates; }

 private:
  pipeline::RenderResult run_sample(const exec::World& world, report::RunInfo& info,
                                    const pipeline::LaunchWatch& watch);

  const LaunchOptions& options_;
  const pipeline::RenderJob& job_;
  pipeline::SampledRun sampled_;  // without its result
};

}  // namespace glint::app
