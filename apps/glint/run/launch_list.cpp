// Runs launches on one device, and keeps the results of each.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/launch_list.h"

#include <fmt/format.h>
#include <utility>

#include "apps/glint/options/observe_options.h"
#include "apps/glint/run/recorded_run.h"
#include "pipeline/device.h"
#include "setup/recorded_launch.h"

namespace glint::app {

std::vector<std::string> launch_folders(const std::vector<std::string>& names) {
  std::vector<std::string> out;
  for (const std::string& name : names) out.push_back(report::launch_folder(out.size(), name));
  return out;
}

pipeline::RenderResult run_launches(const LaunchList& list, const report::RunInfo& info,
                                    const pipeline::LaunchWatch& watch, std::vector<std::string>& lines) {
  pipeline::Device device(list.job.gpu);
  pipeline::RenderResult sum;
  const std::vector<ListedLaunch>& launches = list.launches;
  for (size_t i = 0; i < launches.size(); ++i) {
    const exec::World& world = launches[i].prepare();
    const auto& [x, y, z] = world.launch_size;
    report::RunDirectory directory(list.directory.path_of(info.launches[i]));
    report::RunInfo own = info;
    own.launches.clear(), own.saved.clear(), own.outputs.clear();
    own.scene = fmt::format("{} {}", info.scene, launches[i].name);
    own.shader = launches[i].shader;
    own.frame[0].second = x, own.frame[1].second = y;
    setup::begin_directory(
        directory, own, list.job.gpu,
        fmt::format("{}  {} x {} x {} threads, {} on {}", own.scene, x, y, z, info.mode, info.config));
    const pipeline::LaunchMode mode{list.job.timing, list.job.no_skip, list.options.threads,
                                    launches[i].warm ? pipeline::Caches::Warm : pipeline::Caches::Cold,
                                    list.options.observe};
    pipeline::RenderResult result = record_launch(
        directory, own, [&] { return device.run(world, mode, watch); },
        [&](const pipeline::RenderResult& ended) {
          directory.write_stats(ended.statistics(), own.compact);
          write_observation(list.options.observe, ended, directory);
        });
    lines.push_back(fmt::format("{:<10} {}, {}", launches[i].name,
                                list.job.timing
                                    ? fmt::format("{} cycles", result.cycles)
                                    : fmt::format("{} warp instructions", result.warp_instructions),
                                directory.path()));
    if (i == 0)
      sum = std::move(result);
    else
      sum.add(result);
    if (sum.end != pipeline::LaunchEnd::Whole) break;
  }
  return sum;
}

}  // namespace glint::app
