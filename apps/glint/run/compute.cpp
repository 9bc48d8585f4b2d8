// Runs a compute program and leaves the sum of its launches, and a table of them.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/compute.h"

#include <fmt/format.h>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "apps/glint/options/observe_options.h"
#include "apps/glint/run/launch_sample.h"
#include "apps/glint/run/recorded_run.h"
#include "compute/host.h"
#include "report/files/config_file.h"
#include "report/files/run_directory.h"
#include "report/terminal/table.h"
#include "setup/recorded_launch.h"

namespace glint::app {
namespace {

constexpr const char* kLaunches = "launches.csv";

// Launches that were not timed have no cycles.
std::string launch_table(const std::vector<compute::LaunchRecord>& launches) {
  std::string out = "launch,kernel,groups_x,groups_y,groups_z,cycles,warp_instructions,lane_instructions\n";
  for (size_t i = 0; i < launches.size(); ++i) {
    const compute::LaunchRecord& launch = launches[i];
    const auto& [x, y, z] = launch.groups;
    out += fmt::format("{},{},{},{},{},{},{},{}\n", i, launch.kernel, x, y, z,
                       launch.cycles ? fmt::format("{}", launch.cycles) : "", launch.warp_instructions,
                       launch.lane_instructions);
  }
  return out;
}

report::RunInfo describe_run(const Session& session, const compute::Program& program,
                             const std::string& input, const pipeline::GpuParams& gpu,
                             const LaunchOptions& options) {
  report::RunInfo info = new_run_info(session, gpu, options.config, options.mode);
  info.scene = program.name;
  info.scene_form = "compute";
  info.scene_note = input;
  info.scene_hash = report::fnv1a(input);
  info.shader = program.name;
  info.on_fault = exec::name_of(options.on_fault);
  info.compact = options.compact();
  info.saved = {kLaunches};
  return info;
}

// Runs the program functionally, and then again up to the last launch that is timed. `done` is the first
// pass, which has computed and checked everything, with the cycles of the second one.
pipeline::RenderResult run_sampled(const compute::Program& program, compute::Size size,
                                   compute::HostSetup setup, LaunchSample& sample,
                                   compute::ProgramResult& done) {
  using Caches = pipeline::Caches;
  setup.run = [&](const std::string& kernel, const exec::World& world) {
    return sample.survey(kernel, world, Caches::Warm, setup.watch);
  };
  done = compute::run_program(program, size, setup);
  if (done.sum.end != pipeline::LaunchEnd::Whole) return std::move(done.sum);
  sample.choose();
  std::optional<pipeline::RenderResult> sum;
  pipeline::RenderResult last;
  size_t launch = 0;
  setup.prints = nullptr;  // The first pass has printed.
  setup.run = [&](const std::string&, const exec::World& world) {
    const bool is_timed = sample.is_timed(launch);
    last = is_timed ? sample.time(launch, world, Caches::Warm, setup.watch)
                    : sample.warm(launch, world, Caches::Warm, setup.watch);
    if (is_timed) done.launches[launch].cycles = last.cycles;
    ++launch;
    pipeline::RenderResult answer;
    answer.end = sample.is_complete() ? pipeline::LaunchEnd::Stopped : last.end;
    if (is_timed && last.end == pipeline::LaunchEnd::Whole) add_result(std::move(last), sum);
    return answer;
  };
  compute::run_program(program, size, setup);
  if (!sample.is_complete()) return ended_early(std::move(done.sum), last);
  sample.finish(*sum);
  return std::move(*sum);
}

}  // namespace

bool names_program(const std::string& what) {
  return compute::find_program(what) != nullptr;
}

void check_program(const std::string& name, const LaunchOptions& options) {
  if (observes(options.observe))
    throw UserError({}, "--profile, --sample, --heat and --trace cannot be used with compute programs",
                    "they belong to one launch, and '" + name + "' may have many");
  if (!options.shaders.include_dirs.empty() || !options.shaders.defines.empty())
    throw UserError({}, "-I and -D cannot be used with compute programs", "their kernels take no macros");
  check_max_cycles(options.max_cycles, options.mode == "timing");
}

Exit run_program(const Session& session, const std::string& what, bool small, const LaunchOptions& options) {
  const compute::Program& program = *compute::find_program(what);
  const std::string input(small ? program.small_input : program.full_input);
  pipeline::RenderJob job;
  job.gpu = gpu_of(session.resources, options);
  job.timing = options.mode == "timing";
  const std::unique_ptr<frontend::ShaderCache> cache = open_shader_cache(options.shaders);
  exec::PrintLog prints(options.print_limit);

  const std::string title =
      fmt::format("{}  {}, {} on {}", program.name, input, options.mode, options.config);
  report::RunDirectory directory(options.out.empty() ? fmt::format("out/{}-{}", what, options.mode)
                                                     : options.out);
  report::RunInfo info = describe_run(session, program, input, job.gpu, options);
  setup::begin_directory(directory, info, job.gpu, title);
  compute::ProgramResult done;
  std::optional<LaunchSample> sample;
  if (options.sample.wants_launches()) sample.emplace(options, job.gpu, options.no_skip, options.threads);
  const pipeline::RenderResult result = run_recorded(
      session, options.max_cycles, directory, info,
      [&](const pipeline::LaunchWatch& watch) {
        const compute::Size size = small ? compute::Size::Small : compute::Size::Full;
        const compute::HostSetup setup{
            job.gpu,
            session.resources.shader_dir("compute"),
            {job.timing, options.no_skip, options.threads, pipeline::Caches::Warm, {}},
            watch,
            cache.get(),
            options.on_fault,
            &prints};
        if (sample) return run_sampled(program, size, setup, *sample, done);
        done = compute::run_program(program, size, setup);
        return std::move(done.sum);
      },
      [&](const pipeline::RenderResult& ended) {
        directory.write_stats(ended.statistics(), options.compact());
        directory.write(kLaunches, launch_table(done.launches));
        if (sample) sample->keep(directory, info);
      },
      &prints);
  return print_result(
      session, options.json, job, result, info, title,
      {fmt::format("launches   {}, {}", done.launches.size(), directory.path_of(kLaunches)),
       fmt::format("checked    {} values, {}", report::with_thousands(done.checked),
                   done.checked ? "all as in the reference" : "because the program was ended early"),
       "statistics " + directory.path_of(options.compact() ? "stats.csv" : "stats.txt")},
      sample ? std::span(sample->estimates()) : std::span<const pipeline::Estimate>());
}

}  // namespace glint::app
