// Runs a sample of a launch's blocks on a part of the machine, and estimates what the whole launch would
// take.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/render.h"
#include "pipeline/sampling/estimates.h"
#include "pipeline/sampling/sample_plan.h"

namespace glint::pipeline {

struct SampledRun {
  RenderResult result;  // of the timed blocks, on the part of the machine; its statistics have the estimates
  std::vector<Estimate> estimates;  // none when the launch was ended early
  SamplePlan plan;
  std::vector<SampleBatch> batches;
};

// Runs a sample of a launch. A result is a function of the launch, the parameters and the options alone, at
// any number of threads. What the launch writes is incomplete afterwards: only blocks of the sample have run.
// Throws UserError for a share that is out of range or too small for the launch, and otherwise as render()
// does. Model: blocks that communicate through global memory see only those of the sample.
SampledRun run_sampled(const exec::World& world, const GpuParams& gpu, const SampleOptions& options,
                       uint32_t threads, const LaunchWatch& watch);

// Renders a sample of a frame, as render_and_drain() renders all of it. Pixels that were not run are 0.
SampledRun render_sampled(RenderJob& job, const SampleOptions& options);

// Returns the batches as a table: blocks that had started, and what each batch counted.
std::string batches_csv(const SampledRun& run);

}  // namespace glint::pipeline
