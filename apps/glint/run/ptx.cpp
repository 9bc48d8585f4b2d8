// Launches a kernel and tells what its buffers hold afterwards.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/ptx.h"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>

#include "apps/glint/options/observe_options.h"
#include "apps/glint/run/launch_file.h"
#include "apps/glint/run/recorded_run.h"
#include "pipeline/kernel_launch.h"
#include "report/files/config_file.h"
#include "report/files/run_directory.h"
#include "setup/recorded_launch.h"
#include "setup/resources.h"

namespace glint::app {
namespace {

std::string read_text(const std::string& path) {
  std::optional<std::string> text = setup::text_of_file(path);
  if (!text) throw UserError({}, fmt::format("cannot read '{}'", path));
  return std::move(*text);
}

// Holds a kernel in memory, with one buffer address per argument, which is 0 for numbers.
struct Launched {
  explicit Launched(frontend::Kernel kernel) : world(std::move(kernel)) {}
  pipeline::KernelWorld world;
  std::vector<Address> buffers;
};

void set_arguments(Launched& launched, const LaunchFile& launch, const std::string& launch_path) {
  const std::vector<frontend::KernelParameter>& parameters = launched.world.kernel().parameters;
  if (parameters.size() != launch.arguments.size())
    throw UserError(
        {launch_path, 0, 0},
        fmt::format("kernel '{}' has {} parameters, and the file gives {} arguments",
                    launched.world.kernel().program.name, parameters.size(), launch.arguments.size()));
  std::vector<std::vector<std::byte>> values;
  for (size_t i = 0; i < parameters.size(); ++i) {
    const LaunchArgument& argument = launch.arguments[i];
    launched.buffers.push_back(0);
    values.push_back(argument.bytes);
    if (argument.is_buffer) {
      const Address at =
          launched.world.memory().allocate(argument.name, std::max<size_t>(argument.bytes.size(), 1));
      launched.world.memory().write(at, argument.bytes.data(), argument.bytes.size());
      launched.buffers.back() = at;
      values.back() = pipeline::KernelWorld::argument(at);
    }
    if (values.back().size() != parameters[i].bytes)
      throw UserError(argument.where,
                      fmt::format("parameter '{}' has {} bytes, and this argument has {}", parameters[i].name,
                                  parameters[i].bytes, values.back().size()));
  }
  launched.world.set_arguments(values);
}

// Returns lines on the buffers that the launch file asks for, and writes those to save into the run
// directory.
std::vector<std::string> keep_buffers(Launched& launched, const LaunchFile& launch,
                                      const report::RunDirectory& directory) {
  std::vector<std::string> lines;
  for (size_t i = 0; i < launch.arguments.size(); ++i) {
    const LaunchArgument& argument = launch.arguments[i];
    if (!argument.is_buffer || (!argument.save && argument.show == 0)) continue;
    const size_t bytes = argument.bytes.size();
    const std::byte* data = launched.world.memory().find(launched.buffers[i], bytes);
    const std::string raw(reinterpret_cast<const char*>(data), bytes);
    std::string line =
        fmt::format("{:<10} {} bytes, fnv1a {:016x}", argument.name, bytes, report::fnv1a(raw));
    if (argument.save) {
      directory.write(argument.name + ".bin", raw);
      line += ", " + directory.path_of(argument.name + ".bin");
    }
    if (argument.show > 0)
      line += "\n             " + first_values(argument.type, data, bytes, argument.show);
    lines.push_back(std::move(line));
  }
  return lines;
}

report::RunInfo describe_run(const Session& session, const LaunchOptions& options,
                             const pipeline::GpuParams& gpu, const std::string& kernel,
                             const std::string& text) {
  report::RunInfo info = new_run_info(session, gpu, options.config, options.mode);
  info.scene = kernel;
  info.scene_form = "kernel";
  info.scene_hash = report::fnv1a(text);
  info.shader = kernel;
  return info;
}

}  // namespace

bool names_kernel(const std::string& what) {
  return what.ends_with(".ptx") || what.ends_with(".toml");
}

Exit run_ptx(const Session& session, const std::string& what, const std::string& launch_file,
             const LaunchOptions& options) {
  check_observation(options.observe, options.mode == "timing");
  check_max_cycles(options.max_cycles, options.mode == "timing");
  const bool is_ptx = what.ends_with(".ptx");
  if (is_ptx && launch_file.empty())
    throw UserError(
        {},
        fmt::format("'{}' needs a launch file: --launch FILE.toml gives grid, block and arguments", what));
  const std::string launch_path = is_ptx ? launch_file : what;
  LaunchFile launch = read_launch(launch_path);
  if (is_ptx) launch.kernel = what;
  pipeline::RenderJob job;
  job.gpu = gpu_of(session.resources, options);

  const std::string text = read_text(launch.kernel);
  const frontend::PtxOptions compiler{{job.gpu.compiler.max_registers, job.gpu.compiler.schedule, false,
                                       false, job.gpu.compiler.guard_latency},
                                      launch.contract};
  Launched launched(frontend::compile_ptx(text, launch.kernel, launch.entry, compiler));
  const std::string name = launched.world.kernel().program.name;
  launched.world.set_grid(launch.grid);
  set_arguments(launched, launch, launch_path);
  launched.world.world.on_fault = options.on_fault;
  launched.world.world.layout = job.gpu.core.layout.make({});

  const auto& [gx, gy, gz] = launch.grid.grid;
  const auto& [bx, by, bz] = launch.grid.block;
  const std::string title = fmt::format("{}  {} x {} x {} blocks of {} x {} x {} threads, {} on {}", name, gx,
                                        gy, gz, bx, by, bz, options.mode, options.config);
  report::RunDirectory directory(options.out.empty() ? fmt::format("out/{}-{}", name, options.mode)
                                                     : options.out);
  report::RunInfo info = describe_run(session, options, job.gpu, name, text);
  info.on_fault = exec::name_of(options.on_fault);
  info.compact = options.compact();
  for (const LaunchArgument& argument : launch.arguments)
    if (argument.is_buffer && argument.save) {
      info.saved.push_back(argument.name + ".bin");
      info.outputs.push_back({argument.name + ".bin", argument.name});
    }
  setup::begin_directory(directory, info, job.gpu, title);
  std::vector<std::string> files;
  const pipeline::RenderResult result = run_recorded(
      session, options.max_cycles, directory, info,
      [&](const pipeline::LaunchWatch& watch) {
        return pipeline::run_world(launched.world.world, job.gpu, options.mode == "timing", options.no_skip,
                                   options.threads, watch, options.observe);
      },
      [&](const pipeline::RenderResult& ended) {
        directory.write_stats(ended.statistics(), options.compact());
        files = keep_buffers(launched, launch, directory);
        files.push_back("statistics " + directory.path_of(options.compact() ? "stats.csv" : "stats.txt"));
        for (std::string& line : write_observation(options.observe, ended, directory))
          files.push_back(std::move(line));
      });
  return print_result(session, options.json, job, result, info, title, std::move(files));
}

}  // namespace glint::app
