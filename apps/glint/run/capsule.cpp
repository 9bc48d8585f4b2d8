// Runs a capsule: one launch of an application, saved by the Vulkan driver with all that it can reach.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/capsule.h"

#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "apps/glint/options/config.h"
#include "apps/glint/options/observe_options.h"
#include "apps/glint/run/outputs.h"
#include "apps/glint/run/recorded_run.h"
#include "base/file_store.h"
#include "pipeline/capsule/capsule_world.h"
#include "report/files/run_directory.h"
#include "setup/capsule_file.h"
#include "setup/recorded_launch.h"

namespace glint::app {
namespace {

// Is an image that the launch may write, with a hash of its first level before the launch.
struct WatchedImage {
  std::string file, name;
  exec::ImageView view;
  uint64_t before = 0;
};

std::string_view texels_of(const mem::AddressSpace& memory, const exec::ImageView& view) {
  const uint64_t bytes = view.bytes_before_level(1);
  const std::byte* const texels = memory.find(view.base, bytes);
  return texels ? std::string_view(reinterpret_cast<const char*>(texels), bytes) : std::string_view();
}

// Returns the images that are bound whole, in the order of their bindings.
std::vector<WatchedImage> images_of(const pipeline::Capsule& capsule, const mem::AddressSpace& memory) {
  std::vector<WatchedImage> out;
  for (const pipeline::BoundResources& bound : capsule.bindings) {
    const auto* images = std::get_if<std::vector<exec::ImageView>>(&bound.elements);
    for (size_t i = 0; images && i < images->size(); ++i) {
      const exec::ImageView& view = (*images)[i];
      const std::string number = images->size() > 1 ? fmt::format("-{}", i) : "";
      const std::string name =
          fmt::format("set{}-binding{}{}", bound.place.first, bound.place.second, number);
      const bool is_whole = view.is_bound && view.stored_layers == view.layers && view.first_layer == 0;
      const bool is_picture = view.shape != isa::ImageShape::Buffer && !texels_of(memory, view).empty();
      if (is_whole && is_picture)
        out.push_back({name + ".png", name, view, content_hash(texels_of(memory, view))});
    }
  }
  return out;
}

std::vector<std::string> keep_images(const std::vector<WatchedImage>& images, const mem::AddressSpace& memory,
                                     const report::RunDirectory& directory, report::RunInfo& info) {
  std::vector<std::string> lines;
  for (const WatchedImage& each : images) {
    const std::string_view texels = texels_of(memory, each.view);
    if (content_hash(texels) == each.before) continue;
    directory.write(each.file, image_file(each.file, each.view, std::as_bytes(std::span(texels))));
    info.saved.push_back(each.file), info.outputs.push_back({each.file, each.name, true});
    lines.push_back(fmt::format("{:<10} {}", each.name, directory.path_of(each.file)));
  }
  return lines;
}

report::RunInfo describe_run(const Session& session, const pipeline::Capsule& capsule,
                             const exec::World& world, const pipeline::GpuParams& gpu,
                             const LaunchOptions& options) {
  report::RunInfo info = new_run_info(session, gpu, options.config, options.mode);
  info.scene = fmt::format("{} {} {}", capsule.program, capsule.kind, capsule.number);
  info.scene_form = "application", info.scene_note = capsule.label;
  info.scene_hash = capsule.hash;
  info.shader = capsule.shader;
  info.on_fault = exec::name_of(options.on_fault);
  info.compact = options.compact();
  info.frame[0].second = world.launch_size[0], info.frame[1].second = world.launch_size[1];
  return info;
}

}  // namespace

bool names_capsule(const std::string& what) {
  return what.ends_with(setup::kCapsuleEnding);
}

Exit run_capsule(const Session& session, const std::string& what, const LaunchOptions& options) {
  const pipeline::Capsule capsule = setup::read_capsule(what);
  const std::unique_ptr<frontend::ShaderCache> cache = open_shader_cache(options.shaders);
  pipeline::RenderJob job;
  job.gpu = read_config(session.resources, options.config, options.settings);
  if (options.max_instructions) job.gpu.core.instruction_budget = options.max_instructions;
  job.timing = options.mode == "timing";
  job.no_skip = options.no_skip;
  check_observation(options.observe, job.timing);
  check_max_cycles(options.max_cycles, job.timing);
  pipeline::CapsuleWorld world(capsule, job.gpu, cache.get());
  for (const std::string& note : world.notes) fmt::print(stderr, "note: {}\n", note);
  exec::PrintLog prints(options.print_limit);
  world.world().prints = &prints;
  world.world().on_fault = options.on_fault;
  const std::vector<WatchedImage> images = images_of(capsule, world.memory());

  report::RunInfo info = describe_run(session, capsule, world.world(), job.gpu, options);
  const auto& [x, y, z] = world.world().launch_size;
  const std::string title = fmt::format("{}: {}  {} x {} x {} {}, {} on {}", info.scene, info.shader, x, y, z,
                                        capsule.rays ? "rays" : "threads", options.mode, options.config);
  const std::string stem = std::filesystem::path(what).stem().string();
  report::RunDirectory directory(options.out.empty() ? fmt::format("out/{}-{}", stem, options.mode)
                                                     : options.out);
  setup::begin_directory(directory, info, job.gpu, title);
  std::vector<std::string> files;
  const pipeline::RenderResult result = run_recorded(
      session, options.max_cycles, directory, info,
      [&](const pipeline::LaunchWatch& watch) {
        return pipeline::run_world(world.world(), job.gpu, job.timing, job.no_skip, options.threads, watch,
                                   options.observe);
      },
      [&](const pipeline::RenderResult& ended) {
        directory.write_stats(ended.statistics(), options.compact());
        files = keep_images(images, world.memory(), directory, info);
        files.push_back("statistics " + directory.path_of(options.compact() ? "stats.csv" : "stats.txt"));
        for (std::string& line : write_observation(options.observe, ended, directory))
          files.push_back(std::move(line));
      },
      &prints);
  return print_result(session, options.json, job, result, info, title, std::move(files));
}

}  // namespace glint::app
