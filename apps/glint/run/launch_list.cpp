// Runs launches on one device, and keeps the results of each.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/launch_list.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <fmt/format.h>
#include <optional>
#include <utility>

#include "apps/glint/options/observe_options.h"
#include "apps/glint/run/launch_sample.h"
#include "apps/glint/run/recorded_run.h"
#include "pipeline/device.h"
#include "setup/recorded_launch.h"

namespace glint::app {

std::vector<std::string> launch_folders(std::vector<std::string> names) {
  const auto is_odd = [](unsigned char c) { return !std::isalnum(c) && c != '-' && c != '_' && c != '.'; };
  for (size_t i = 0; i < names.size(); ++i) {
    std::replace_if(names[i].begin(), names[i].end(), is_odd, '_');
    names[i] = report::launch_folder(i, names[i]);
  }
  return names;
}

void LaunchRecorder::record(const std::string& name, const std::string& shader, const exec::World& world,
                            const std::function<pipeline::RenderResult()>& run, exec::PrintLog* prints) {
  const auto& [x, y, z] = world.launch_size;
  report::RunDirectory directory(directory_.path_of(info_.launches.at(num_begun_)));
  ++num_begun_;
  report::RunInfo own = info_;
  own.launches.clear(), own.saved.clear(), own.outputs.clear();
  own.scene = fmt::format("{} {}", info_.scene, name);
  own.shader = shader;
  own.frame[0].second = x, own.frame[1].second = y;
  setup::begin_directory(
      directory, own, gpu_,
      fmt::format("{}  {} x {} x {} threads, {} on {}", own.scene, x, y, z, own.mode, own.config));
  pipeline::RenderResult result = record_launch(
      directory, own, run,
      [&](const pipeline::RenderResult& ended) {
        directory.write_stats(ended.statistics(), own.compact);
        write_observation(options_.observe, ended, directory);
      },
      prints);
  lines_.push_back(fmt::format("{:<10} {}, {}", name,
                               own.mode == "timing"
                                   ? fmt::format("{} cycles", result.cycles)
                                   : fmt::format("{} warp instructions", result.warp_instructions),
                               directory.path()));
  if (lines_.size() == 1)
    sum_ = std::move(result);
  else
    sum_.add(result);
}

namespace {

// Keeps the bytes of a simulated memory, so that launches can run from them again.
class MemoryImage {
 public:
  explicit MemoryImage(mem::AddressSpace& memory) {
    for (const mem::AddressSpace::Slot& slot : memory.slots())
      if (slot.data)
        parts_.emplace_back(slot.data, std::vector<std::byte>(slot.data, slot.data + slot.bytes));
  }
  void restore() const {
    for (const auto& [to, bytes] : parts_) std::ranges::copy(bytes, to);
  }

 private:
  std::vector<std::pair<std::byte*, std::vector<std::byte>>> parts_;
};

pipeline::Caches caches_of(const ListedLaunch& launch) {
  return launch.warm ? pipeline::Caches::Warm : pipeline::Caches::Cold;
}

// Runs all launches functionally. Returns their sum.
pipeline::RenderResult survey(const LaunchList& list, const pipeline::LaunchWatch& watch,
                              LaunchSample& sample) {
  std::optional<pipeline::RenderResult> sum;
  for (const ListedLaunch& launch : list.launches) {
    const exec::World& world = launch.prepare();
    add_result(sample.survey(launch.shader, world, caches_of(launch), watch), sum);
    if (sum->end != pipeline::LaunchEnd::Whole) break;
  }
  return std::move(*sum);
}

// Times the chosen launches, each in a directory of its own, and runs those before them functionally. Returns
// the sum of the timed ones, or `surveyed`, when a launch was ended early.
pipeline::RenderResult time_chosen(const LaunchList& list, report::RunInfo& info,
                                   const pipeline::LaunchWatch& watch, pipeline::RenderResult&& surveyed,
                                   LaunchSample& sample, ListResults& results) {
  LaunchRecorder recorder(list.options, list.job.gpu, list.directory, info);
  for (size_t i = 0; !sample.is_complete(); ++i) {
    const ListedLaunch& launch = list.launches[i];
    exec::World& world = launch.prepare();
    world.prints = nullptr;  // The first pass has printed.
    pipeline::RenderResult warmed;
    if (sample.is_timed(i))
      recorder.record(launch.name, launch.shader, world,
                      [&] { return sample.time(i, world, caches_of(launch), watch); });
    else
      warmed = sample.warm(i, world, caches_of(launch), watch);
    const pipeline::RenderResult& last = sample.is_timed(i) ? recorder.sum() : warmed;
    results.lines = recorder.lines();
    if (last.end == pipeline::LaunchEnd::Whole) continue;
    info.launches.resize(recorder.num_begun());
    return ended_early(std::move(surveyed), last);
  }
  sample.finish(recorder.sum());
  return std::move(recorder.sum());
}

pipeline::RenderResult run_sampled(const LaunchList& list, report::RunInfo& info,
                                   const pipeline::LaunchWatch& watch, ListResults& results) {
  LaunchSample sample(list.options, list.job.gpu, list.job.no_skip, list.options.threads);
  mem::AddressSpace& memory = *list.launches[0].prepare().memory;
  const MemoryImage before(memory);
  pipeline::RenderResult surveyed = survey(list, watch, sample);
  if (surveyed.end != pipeline::LaunchEnd::Whole) {
    info.launches.clear();
    return surveyed;
  }
  sample.choose();
  sample.keep_timed(info.launches);
  const MemoryImage after(memory);
  before.restore();
  pipeline::RenderResult sum = time_chosen(list, info, watch, std::move(surveyed), sample, results);
  after.restore();  // What the run saves is what all launches have left.
  sample.keep(list.directory, info);
  results.estimates = sample.estimates();
  return sum;
}

}  // namespace

void check_listed(const SampleChoice& choice, bool is_list, bool timing, const std::string& what) {
  if (choice.wants_launches() && !is_list)
    throw UserError({}, fmt::format("--sample-launches cannot be used with '{}', which has one launch", what),
                    "it samples compute programs, lists of launches and --frames");
  if (choice.wants_pixels() && is_list)
    throw UserError(
        {}, fmt::format("--sample-pixels cannot be used with '{}', which has a list of launches", what),
        "it samples the blocks of one launch; --sample-launches samples several launches");
  if (!choice.given().empty() && !timing)
    throw UserError({what},
                    choice.given() + " needs the timing machine, and the file says mode = \"functional\"",
                    "--mode timing overrides it");
}

pipeline::RenderResult run_launches(const LaunchList& list, report::RunInfo& info,
                                    const pipeline::LaunchWatch& watch, ListResults& results) {
  if (list.options.sample.wants_launches()) return run_sampled(list, info, watch, results);
  pipeline::Device device(list.job.gpu);
  LaunchRecorder recorder(list.options, list.job.gpu, list.directory, info);
  for (const ListedLaunch& launch : list.launches) {
    const exec::World& world = launch.prepare();
    const pipeline::LaunchMode mode{list.job.timing, list.job.no_skip, list.options.threads,
                                    caches_of(launch), list.options.observe};
    recorder.record(launch.name, launch.shader, world, [&] { return device.run(world, mode, watch); });
    if (recorder.sum().end != pipeline::LaunchEnd::Whole) break;
  }
  results.lines = recorder.lines();
  return std::move(recorder.sum());
}

}  // namespace glint::app
