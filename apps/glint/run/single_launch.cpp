// Runs one launch, and keeps what is known of it alone.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/single_launch.h"

#include <utility>

#include "apps/glint/options/observe_options.h"

namespace glint::app {

report::SampleInfo sample_info(const pipeline::SampleOptions& options, const pipeline::SamplePlan& plan) {
  return {.share = options.share,
          .seed = options.seed,
          .all = plan.num_blocks,
          .timed = plan.timed.size(),
          .scale = plan.scale,
          .warm = plan.num_functional(),
          .by = options.by};
}

pipeline::RenderResult SingleLaunch::run(const exec::World& world, report::RunInfo& info,
                                         const pipeline::LaunchWatch& watch) {
  if (options_.sample.wants_pixels()) return run_sample(world, info, watch);
  return pipeline::run_world(world, job_.gpu, job_.timing, job_.no_skip, options_.threads, watch,
                             options_.observe);
}

pipeline::RenderResult SingleLaunch::run_sample(const exec::World& world, report::RunInfo& info,
                                                const pipeline::LaunchWatch& watch) {
  const pipeline::SampleOptions options = options_.sample.options();
  try {
    sampled_ = pipeline::run_sampled(world, job_.gpu, options, options_.threads, watch);
  } catch (const Error& error) {
    if (error.exit() != Exit::Fault && error.exit() != Exit::Stuck) throw;
    throw Error(error.exit(), std::string(error.what()) +
                                  "\n  note: only the blocks of a sample ran, and a launch whose blocks wait "
                                  "for others needs all of them; leave --sample-pixels away");
  }
  info.sample = sample_info(options, sampled_.plan);
  return std::move(sampled_.result);
}

std::vector<std::string> SingleLaunch::keep(const pipeline::RenderResult& ended,
                                            const report::RunDirectory& directory) const {
  if (!options_.sample.wants_pixels()) return write_observation(options_.observe, ended, directory);
  directory.write("sample.csv", pipeline::batches_csv(sampled_));
  return {"incomplete images and buffers have only what the blocks of the sample wrote"};
}

}  // namespace glint::app
