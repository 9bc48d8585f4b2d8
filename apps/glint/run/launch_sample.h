// Runs a sample of the launches of a program, a list or a sequence of frames: all launches run functionally
// once, and the chosen ones are timed in a second pass.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/glint/run/launch_options.h"
#include "pipeline/device.h"
#include "pipeline/sampling/launch_estimates.h"
#include "pipeline/sampling/launch_traces.h"
#include "pipeline/sampling/warm_launch.h"
#include "report/characterize/strata.h"
#include "report/files/run_directory.h"

namespace glint::app {

// The caller goes through its launches twice, in the same order and from the same memory. Launches that are
// not timed run once, where their traces have room (pipeline::LaunchTraces):
//
//   for (..) sample.survey("kernel", world, caches, watch);  // every launch leaves its counts
//   sample.choose();                                      // clusters the launches, and draws some of each
//   for (i = 0; !sample.is_complete(); ++i)
//     if (sample.is_timed(i)) sample.time(i, world, caches, watch);
//     else sample.warm(i, world, caches, watch);          // for memory, and for what the L2 holds
//   sample.finish(sum);                                   // adds the estimates to the sum of timed launches
//   sample.keep(directory, info);
//
// The timed launches and the estimates are a function of launches, parameters and options alone.
class LaunchSample {
 public:
  // Says whether launches leave traces. They need not where hardly any launch is warmed.
  enum class Traces : uint8_t { Kept, None };
  LaunchSample(const LaunchOptions& options, const pipeline::GpuParams& gpu, bool no_skip, uint32_t threads,
               Traces traces = Traces::Kept);

  // Runs a launch functionally, and notes what it did. `kernel` names launches that may be alike. The first
  // one of a kernel, and those that find empty caches, are not like those that find what others have touched.
  pipeline::RenderResult survey(const std::string& kernel, const exec::World& world, pipeline::Caches caches,
                                const pipeline::LaunchWatch& watch);
  // Chooses the launches to time. Throws UserError when the sample has another size than it may have.
  void choose();

  bool is_timed(size_t launch) const { return drawn_of_.contains(launch); }
  bool is_complete() const { return timed_.size() == strata_.drawn.size(); }
  size_t num_launches() const { return surveyed_.size(); }
  // Keeps those of a list with an entry for each launch that are timed.
  void keep_timed(std::vector<std::string>& names) const;

  pipeline::RenderResult time(size_t launch, const exec::World& world, pipeline::Caches caches,
                              const pipeline::LaunchWatch& watch);
  // Does to memory and to the L2 what a launch that is not timed does.
  pipeline::RenderResult warm(size_t launch, const exec::World& world, pipeline::Caches caches,
                              const pipeline::LaunchWatch& watch);

  // Adds estimates, and the faults of all launches, to the sum of the timed ones.
  void finish(pipeline::RenderResult& sum);
  const std::vector<pipeline::Estimate>& estimates() const { return estimates_; }

  // Write sample.csv and signatures.csv, and say in `info` what was sampled.
  void keep(const report::RunDirectory& directory, report::RunInfo& info) const;

 private:
  struct Surveyed {
    std::string kernel;
    bool finds_nothing = false;  // of its data in the caches
    std::vector<double> counts;  // in the order of kCounts
  };
  std::string signatures_csv() const;

  const SampleChoice& choice_;
  const pipeline::GpuParams gpu_;
  const pipeline::LaunchMode mode_;
  const Traces keeps_;
  pipeline::Device device_;
  pipeline::LaunchTraces traces_;
  pipeline::WarmCaches warm_;
  std::vector<Surveyed> surveyed_;
  exec::FaultLog faults_;
  report::Strata strata_;
  std::map<size_t, size_t> drawn_of_;  // places in strata_.drawn, by launch
  std::vector<pipeline::TimedLaunch> timed_;
  std::vector<pipeline::Estimate> estimates_;
};

// Returns the first pass of a run whose second one was ended early in a launch. Its counts are those of the
// functional machine.
pipeline::RenderResult ended_early(pipeline::RenderResult&& surveyed, const pipeline::RenderResult& in);

// Adds a result to a sum, which may be empty.
void add_result(pipeline::RenderResult&& result, std::optional<pipeline::RenderResult>& sum);

}  // namespace glint::app
