// Runs a described pipeline: takes shaders from anywhere and resources from the file, and keeps its outputs.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/pipeline.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <memory>

#include "apps/glint/options/config.h"
#include "apps/glint/options/observe_options.h"
#include "apps/glint/run/launch_list.h"
#include "apps/glint/run/outputs.h"
#include "apps/glint/run/recorded_run.h"
#include "apps/glint/run/single_launch.h"
#include "base/host_threads.h"
#include "pipeline/description/defaults.h"
#include "pipeline/description/pictures.h"
#include "pipeline/pipeline_world.h"
#include "report/files/config_file.h"
#include "report/files/run_directory.h"
#include "setup/recorded_launch.h"

namespace glint::app {
namespace {

bool is_shader(const std::string& what) {
  return frontend::stage_of_file(what).has_value() || what.ends_with(".spv") || what.ends_with(".spvasm");
}

// Returns the description with the command line's options, which win over the file's.
pipeline::PipelineDescription with_options(pipeline::PipelineDescription description,
                                           const frontend::GlslOptions& glsl) {
  for (pipeline::ShaderFile& shader : description.shaders) {
    auto& dirs = shader.glsl.include_dirs;
    dirs.insert(dirs.end(), glsl.include_dirs.begin(), glsl.include_dirs.end());
    auto& defines = shader.glsl.defines;
    std::erase_if(defines, [&](const auto& d) {
      return std::any_of(glsl.defines.begin(), glsl.defines.end(),
                         [&](const auto& o) { return o.first == d.first; });
    });
    defines.insert(defines.end(), glsl.defines.begin(), glsl.defines.end());
    shader.glsl.cache = glsl.cache;
  }
  return description;
}

void check_outputs(const pipeline::PipelineDescription& d) {
  Diagnostics errors;
  for (const auto& buffer : d.buffers) check_saves(buffer.saves, false, errors);
  for (const auto& image : d.images) check_saves(image.saves, true, errors);
  errors.throw_if_errors();
}

// Writes what the file asks for. Returns lines for the summary.
std::vector<std::string> keep(pipeline::PipelineWorld& world, const report::RunDirectory& directory,
                              const pipeline::RenderResult& result, report::RunInfo& info, uint32_t threads) {
  std::vector<std::string> lines;
  const pipeline::PipelineDescription& d = world.description();
  for (size_t i = 0; i < d.images.size(); ++i) {
    if (d.images[i].saves.empty()) continue;
    const exec::ImageView& view = world.image(i);
    const std::byte* const texels = world.memory().find(view.base, view.bytes_before_level(1));
    for (std::string& line : save_image(d.images[i], view, world.memory(), directory, threads))
      lines.push_back(std::move(line));
    const std::vector<float> floats = pipeline::texels_as_floats(view, texels);
    note_not_finite(d.images[i].saves[0].file, {view.width, view.height * view.depth * view.layers, floats},
                    view, result, info);
  }
  for (size_t i = 0; i < d.buffers.size(); ++i) {
    const pipeline::BufferDescription& b = d.buffers[i];
    for (const pipeline::Save& save : b.saves) {
      directory.write(save.file, buffer_file(save.file, b.data.type, world.buffer(i)));
      lines.push_back(fmt::format("{:<10} {}", b.name, directory.path_of(save.file)));
    }
    if (b.show > 0)
      lines.push_back(fmt::format("{:<10} {}", b.name, first_numbers(b.data.type, world.buffer(i), b.show)));
  }
  return lines;
}

// Holds what the launches run on.
struct Machine {
  std::string mode, config;
  pipeline::RenderJob job;
};

// Returns the machine of a file. The command line's options win over the file's.
Machine machine_of(const Session& session, const pipeline::MachineDescription& file,
                   const LaunchOptions& options) {
  const auto first = [](const std::string& a, const std::string& b, const char* c) {
    return !a.empty() ? a : !b.empty() ? b : std::string(c);
  };
  Machine out;
  out.mode = first(options.mode_given ? options.mode : "", file.mode, "timing");
  out.config = first(options.config_given ? options.config : "", file.config, "mobile");
  std::vector<std::string> settings = file.settings;
  settings.insert(settings.end(), options.settings.begin(), options.settings.end());
  out.job.gpu = read_config(session.resources, out.config, settings);
  const uint64_t budget = options.max_instructions ? options.max_instructions : file.max_instructions;
  if (budget) out.job.gpu.core.instruction_budget = budget;
  out.job.timing = out.mode == "timing";
  out.job.no_skip = options.no_skip;
  check_observation(options.observe, out.job.timing);
  check_max_cycles(options.max_cycles, out.job.timing);
  return out;
}

report::RunInfo describe_run(const Session& session, const pipeline::PipelineWorld& world,
                             const std::string& file, const Machine& machine) {
  report::RunInfo info = new_run_info(session, machine.job.gpu, machine.config, machine.mode);
  info.scene = world.description().name;
  info.scene_form = "pipeline";
  info.scene_file = file;
  std::string everything;  // everything that the launch begins with
  for (const mem::AddressSpace::Slot& slot : world.memory().slots())
    if (slot.data) everything.append(reinterpret_cast<const char*>(slot.data), size_t(slot.bytes));
  info.scene_hash = report::fnv1a(everything);
  for (const pipeline::ShaderModule& module : world.modules().all())
    info.shader += (info.shader.empty() ? "" : " ") + module.name;
  const auto add = [&](const auto& resources, bool is_image) {
    for (const auto& resource : resources)
      for (const pipeline::Save& save : resource.saves) {
        info.saved.push_back(save.file);
        info.outputs.push_back({save.file, resource.name, is_image});
      }
  };
  add(world.description().images, true);
  add(world.description().buffers, false);
  std::vector<std::string> names;
  for (const pipeline::LaunchDescription& launch : world.description().launches)
    if (!launch.name.empty()) names.push_back(launch.name);
  info.launches = launch_folders(names);
  info.frame[0].second = world.world().launch_size[0];
  info.frame[1].second = world.world().launch_size[1];
  return info;
}

std::string shader_of(const pipeline::LaunchDescription& launch) {
  if (!launch.compute.empty()) return launch.compute;
  return launch.raygen->group.empty() ? launch.raygen->inlined.general : launch.raygen->group;
}

pipeline::RenderResult run_list(LaunchList list, pipeline::PipelineWorld& world, report::RunInfo& info,
                                const pipeline::LaunchWatch& watch, ListResults& results) {
  const auto& launches = world.description().launches;
  for (size_t i = 0; i < launches.size(); ++i)
    list.launches.push_back({launches[i].name, shader_of(launches[i]), launches[i].warm,
                             [&world, i]() -> exec::World& { return world.world(i); }});
  return run_launches(list, info, watch, results);
}

// Names the pipeline and says how large it is.
std::string what_of(const pipeline::PipelineWorld& world, bool is_list) {
  const pipeline::PipelineDescription& d = world.description();
  if (is_list) return fmt::format("{}  {} launches", d.name, world.num_launches());
  const auto& [x, y, z] = world.world().launch_size;
  return fmt::format("{}  {} x {} x {} {}", d.name, x, y, z,
                     d.launches[0].compute.empty() ? "rays" : "threads");
}

}  // namespace

bool names_pipeline(const std::string& what) {
  if (is_shader(what)) return true;
  if (!what.ends_with(".toml")) return false;
  return pipeline::read_toml(what).find("kernel") == nullptr;  // A kernel's launch file has this key.
}

pipeline::PipelineDescription read_description(const std::string& what, const frontend::GlslOptions& glsl) {
  if (!is_shader(what)) return with_options(pipeline::read_pipeline(what), glsl);
  const std::vector<std::string> shaders = pipeline::with_companions(what);
  const std::filesystem::path path(what);
  const std::string name = (path.parent_path() / ("defaults of " + path.filename().string())).string();
  pipeline::PipelineDescription out = pipeline::parse_pipeline(
      pipeline::default_description(shaders, path.parent_path().string(), glsl), name);
  out.name = path.filename().string();
  return with_options(std::move(out), glsl);
}

Exit run_pipeline(const Session& session, const std::string& what, const LaunchOptions& options) {
  const std::unique_ptr<frontend::ShaderCache> cache = open_shader_cache(options.shaders);
  const pipeline::PipelineDescription description =
      read_description(what, glsl_options(options.shaders, cache.get()));
  check_outputs(description);
  const Machine machine = machine_of(session, description.machine, options);
  const pipeline::RenderJob& job = machine.job;
  const bool is_list = !description.launches[0].name.empty();
  check_listed(options.sample, is_list, job.timing, what);
  pipeline::PipelineWorld world(description, job.gpu, host_threads(job.threads));
  exec::PrintLog prints(options.print_limit);
  for (size_t i = 0; i < world.num_launches(); ++i)
    world.world(i).prints = &prints, world.world(i).on_fault = options.on_fault;
  for (const std::string& warning : world.warnings) fmt::print(stderr, "{}\n", warning);

  const std::string title =
      fmt::format("{}, {} on {}", what_of(world, is_list), machine.mode, machine.config);
  report::RunDirectory directory(
      options.out.empty() ? fmt::format("out/{}-{}", description.name, machine.mode) : options.out);
  report::RunInfo info = describe_run(session, world, what, machine);
  info.on_fault = exec::name_of(options.on_fault);
  info.compact = options.compact();
  setup::begin_directory(directory, info, job.gpu, title);
  std::vector<std::string> files;
  ListResults launches;
  SingleLaunch launch(options, job);
  const pipeline::RenderResult result = run_recorded(
      session, options.max_cycles, directory, info,
      [&](const pipeline::LaunchWatch& watch) {
        pipeline::RenderResult ran =
            is_list ? run_list({options, job, directory, {}}, world, info, watch, launches)
                    : launch.run(world.world(), info, watch);
        ran.structures = world.structures, ran.warnings = world.warnings;
        return ran;
      },
      [&](const pipeline::RenderResult& ended) {
        directory.write_stats(ended.statistics(), options.compact());
        files = keep(world, directory, ended, info, host_threads(job.threads));
        files.push_back("statistics " + directory.path_of(options.compact() ? "stats.csv" : "stats.txt"));
        files.insert(files.begin(), launches.lines.begin(), launches.lines.end());
        if (is_list) return;  // Each launch has kept its own.
        for (std::string& line : launch.keep(ended, directory)) files.push_back(std::move(line));
      },
      &prints);
  return print_result(session, options.json, job, result, info, title, std::move(files),
                      is_list ? launches.estimates : launch.estimates());
}

}  // namespace glint::app
