// Runs launches on one device, and keeps the results of each.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/launch_list.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <utility>

#include "apps/glint/options/observe_options.h"
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

pipeline::RenderResult run_launches(const LaunchList& list, const report::RunInfo& info,
                                    const pipeline::LaunchWatch& watch, std::vector<std::string>& lines) {
  pipeline::Device device(list.job.gpu);
  LaunchRecorder recorder(list.options, list.job.gpu, list.directory, info);
  for (const ListedLaunch& launch : list.launches) {
    const exec::World& world = launch.prepare();
    const pipeline::LaunchMode mode{list.job.timing, list.job.no_skip, list.options.threads,
                                    launch.warm ? pipeline::Caches::Warm : pipeline::Caches::Cold,
                                    list.options.observe};
    recorder.record(launch.name, launch.shader, world, [&] { return device.run(world, mode, watch); });
    if (recorder.sum().end != pipeline::LaunchEnd::Whole) break;
  }
  lines = recorder.lines();
  return std::move(recorder.sum());
}

}  // namespace glint::app
