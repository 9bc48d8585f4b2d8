// Launches kernels and tells what their buffers hold afterwards.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/ptx.h"

#include <filesystem>
#include <fmt/format.h>
#include <utility>
#include <vector>

#include "apps/glint/options/observe_options.h"
#include "apps/glint/run/kernels.h"
#include "apps/glint/run/launch_file.h"
#include "apps/glint/run/launch_list.h"
#include "apps/glint/run/recorded_run.h"
#include "apps/glint/run/single_launch.h"
#include "report/files/config_file.h"
#include "report/files/run_directory.h"
#include "setup/recorded_launch.h"

namespace glint::app {
namespace {

report::RunInfo describe_run(const Session& session, const LaunchOptions& options,
                             const pipeline::GpuParams& gpu, const std::string& name, Kernels& kernels,
                             const LaunchFile& file) {
  report::RunInfo info = new_run_info(session, gpu, options.config, options.mode);
  info.scene = name;
  info.scene_form = "kernel";
  info.scene_hash = report::fnv1a(kernels.text());
  std::vector<std::string> names;
  for (size_t i = 0; i < file.launches.size(); ++i)
    if (info.shader.find(kernels.name(i)) == std::string::npos)
      info.shader += (i ? " " : "") + kernels.name(i);
  if (file.is_list())
    for (const KernelLaunch& launch : file.launches) names.push_back(launch.name);
  info.launches = launch_folders(names);
  info.on_fault = exec::name_of(options.on_fault);
  info.compact = options.compact();
  kernels.describe_saved(info);
  return info;
}

std::string title_of(const LaunchFile& file, const std::string& name, const LaunchOptions& options) {
  if (file.is_list())
    return fmt::format("{}  {} launches, {} on {}", name, file.launches.size(), options.mode, options.config);
  const auto& [gx, gy, gz] = file.launches[0].grid.grid;
  const auto& [bx, by, bz] = file.launches[0].grid.block;
  return fmt::format("{}  {} x {} x {} blocks of {} x {} x {} threads, {} on {}", name, gx, gy, gz, bx, by,
                     bz, options.mode, options.config);
}

std::vector<ListedLaunch> listed(const LaunchFile& file, Kernels& kernels) {
  std::vector<ListedLaunch> out;
  for (size_t i = 0; i < file.launches.size(); ++i)
    out.push_back({file.launches[i].name, kernels.name(i), file.launches[i].warm,
                   [&kernels, i]() -> exec::World& { return kernels.prepare(i); }});
  return out;
}

// Reads the launch file, or that of a kernel that the user names.
LaunchFile read_file(const std::string& what, const std::string& path) {
  LaunchFile out = read_launch(path);
  if (!what.ends_with(".ptx")) return out;
  if (out.is_list())
    throw UserError({path},
                    fmt::format("the file has a list of launches, which say their kernels themselves"),
                    fmt::format("run it without '{}'", what));
  out.launches[0].kernel = what;
  return out;
}

}  // namespace

bool names_kernel(const std::string& what) {
  return what.ends_with(".ptx") || what.ends_with(".toml");
}

Exit run_ptx(const Session& session, const std::string& what, const std::string& launch_file,
             const LaunchOptions& options) {
  check_observation(options.observe, options.mode == "timing");
  check_max_cycles(options.max_cycles, options.mode == "timing");
  if (what.ends_with(".ptx") && launch_file.empty())
    throw UserError(
        {},
        fmt::format("'{}' needs a launch file: --launch FILE.toml gives grid, block and arguments", what));
  const std::string launch_path = what.ends_with(".ptx") ? launch_file : what;
  const LaunchFile file = read_file(what, launch_path);
  pipeline::RenderJob job;
  job.gpu = gpu_of(session.resources, options);
  job.timing = options.mode == "timing", job.no_skip = options.no_skip;
  check_listed(options.sample, file.is_list(), job.timing, what);
  exec::PrintLog prints(options.print_limit);
  Kernels kernels(file, launch_path, job.gpu, options, &prints);
  const std::string name =
      file.is_list() ? std::filesystem::path(launch_path).stem().string() : kernels.name(0);

  const std::string title = title_of(file, name, options);
  report::RunDirectory directory(options.out.empty() ? fmt::format("out/{}-{}", name, options.mode)
                                                     : options.out);
  report::RunInfo info = describe_run(session, options, job.gpu, name, kernels, file);
  if (!what.ends_with(".ptx")) info.scene_file = what;
  setup::begin_directory(directory, info, job.gpu, title);
  std::vector<std::string> files;
  ListResults launches;
  SingleLaunch launch(options, job);
  const pipeline::RenderResult result = run_recorded(
      session, options.max_cycles, directory, info,
      [&](const pipeline::LaunchWatch& watch) {
        if (file.is_list())
          return run_launches({options, job, directory, listed(file, kernels)}, info, watch, launches);
        return launch.run(kernels.prepare(0), info, watch);
      },
      [&](const pipeline::RenderResult& ended) {
        directory.write_stats(ended.statistics(), options.compact());
        files = std::move(launches.lines);
        for (std::string& line : kernels.keep_buffers(directory)) files.push_back(std::move(line));
        files.push_back("statistics " + directory.path_of(options.compact() ? "stats.csv" : "stats.txt"));
        if (file.is_list()) return;  // Each launch has kept its own.
        for (std::string& line : launch.keep(ended, directory)) files.push_back(std::move(line));
      },
      &prints);
  return print_result(session, options.json, job, result, info, title, std::move(files),
                      file.is_list() ? launches.estimates : launch.estimates());
}

}  // namespace glint::app
