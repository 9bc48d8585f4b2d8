// Runs a capsule: one launch of an application, saved by the Vulkan driver with all that it can reach.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/capsule.h"

#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "apps/glint/options/config.h"
#include "apps/glint/options/observe_options.h"
#include "apps/glint/run/outputs.h"
#include "apps/glint/run/recorded_run.h"
#include "apps/glint/run/single_launch.h"
#include "base/file_store.h"
#include "pipeline/capsule/capsule_world.h"
#include "report/files/run_directory.h"
#include "setup/capsule_file.h"
#include "setup/recorded_launch.h"

namespace glint::app {
namespace {

// Is an image or a buffer that the launch may write, with a hash of its bytes before the launch: of an image,
// those of its first level.
struct Watched {
  std::string file, name;
  std::optional<exec::ImageView> image;
  Address at = 0;
  uint64_t bytes = 0, before = 0;
};

std::string_view bytes_of(const mem::AddressSpace& memory, const Watched& watched) {
  const std::byte* const found = memory.find(watched.at, watched.bytes);
  return found ? std::string_view(reinterpret_cast<const char*>(found), watched.bytes) : std::string_view();
}

// Gathers what a launch may write, each place once: images that are bound whole, buffers that are bound, in
// the order of their bindings, and allocations that shaders can reach by address alone.
class WatchList {
 public:
  explicit WatchList(const mem::AddressSpace& memory) : memory_(memory) {}

  void add_bound(const pipeline::BoundResources& bound) {
    if (const auto* images = std::get_if<std::vector<exec::ImageView>>(&bound.elements))
      for (size_t i = 0; i < images->size(); ++i) add_image((*images)[i], name_of(bound, images->size(), i));
    if (const auto* buffers = std::get_if<std::vector<pipeline::BufferRange>>(&bound.elements))
      for (size_t i = 0; i < buffers->size(); ++i)
        add_bytes((*buffers)[i].address, (*buffers)[i].bytes, name_of(bound, buffers->size(), i));
  }

  void add_rest(const pipeline::SavedMemory& memory) {
    const std::set<uint64_t> bound = slots_;
    for (const auto& window : memory.windows)
      if (!bound.count(window.slot))
        add_bytes(window.slot << mem::AddressSpace::kShift, window.bytes,
                  fmt::format("allocation-{}", window.slot));
  }

  std::vector<Watched> all;

 private:
  static std::string name_of(const pipeline::BoundResources& bound, size_t count, size_t i) {
    const std::string number = count > 1 ? fmt::format("-{}", i) : "";
    return fmt::format("set{}-binding{}{}", bound.place.first, bound.place.second, number);
  }

  void add_image(const exec::ImageView& view, const std::string& name) {
    if (!view.is_bound) return;
    slots_.insert(view.base >> mem::AddressSpace::kShift);
    if (view.stored_layers != view.layers || view.first_layer || view.shape == isa::ImageShape::Buffer)
      return;
    add({name + ".png", name, view, view.base, view.bytes_before_level(1)});
  }

  void add_bytes(Address at, uint64_t bytes, const std::string& name) {
    if (!bytes) return;  // It is a structure, or nothing is bound.
    slots_.insert(at >> mem::AddressSpace::kShift);
    add({name + ".bin", name, std::nullopt, at, bytes});
  }

  void add(Watched watched) {
    const std::string_view bytes = bytes_of(memory_, watched);
    if (bytes.empty() || !seen_.insert({watched.at, watched.bytes}).second) return;
    watched.before = content_hash(bytes);
    all.push_back(std::move(watched));
  }

  const mem::AddressSpace& memory_;
  std::set<uint64_t> slots_;
  std::set<std::pair<Address, uint64_t>> seen_;
};

std::vector<Watched> watch(const pipeline::Capsule& capsule, const mem::AddressSpace& memory) {
  WatchList list(memory);
  for (const pipeline::BoundResources& bound : capsule.bindings) list.add_bound(bound);
  list.add_rest(capsule.memory);
  return std::move(list.all);
}

std::vector<std::string> keep_changed(const std::vector<Watched>& all, const mem::AddressSpace& memory,
                                      const report::RunDirectory& directory, report::RunInfo& info) {
  std::vector<std::string> lines;
  for (const Watched& each : all) {
    const std::string_view bytes = bytes_of(memory, each);
    if (content_hash(bytes) == each.before) continue;
    if (each.image)
      directory.write(each.file, image_file(each.file, *each.image, std::as_bytes(std::span(bytes))));
    else
      directory.write(each.file, std::string(bytes));
    info.saved.push_back(each.file), info.outputs.push_back({each.file, each.name, each.image.has_value()});
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
  if (capsule.has_micromaps && job.gpu.rt.leaf_filter.name == rt::LeafFilter::kNone)
    job.gpu.rt.leaf_filter = rt::LeafFilter::kMicromaps;
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
  const std::vector<Watched> watched = watch(capsule, world.memory());

  report::RunInfo info = describe_run(session, capsule, world.world(), job.gpu, options);
  const auto& [x, y, z] = world.world().launch_size;
  const std::string title = fmt::format("{}: {}  {} x {} x {} {}, {} on {}", info.scene, info.shader, x, y, z,
                                        capsule.rays ? "rays" : "threads", options.mode, options.config);
  const std::string stem = std::filesystem::path(what).stem().string();
  report::RunDirectory directory(options.out.empty() ? fmt::format("out/{}-{}", stem, options.mode)
                                                     : options.out);
  setup::begin_directory(directory, info, job.gpu, title);
  std::vector<std::string> files;
  SingleLaunch launch(options, job);
  const pipeline::RenderResult result = run_recorded(
      session, options.max_cycles, directory, info,
      [&](const pipeline::LaunchWatch& watch) { return launch.run(world.world(), info, watch); },
      [&](const pipeline::RenderResult& ended) {
        directory.write_stats(ended.statistics(), options.compact());
        files = keep_changed(watched, world.memory(), directory, info);
        files.push_back("statistics " + directory.path_of(options.compact() ? "stats.csv" : "stats.txt"));
        for (std::string& line : launch.keep(ended, directory)) files.push_back(std::move(line));
      },
      &prints);
  return print_result(session, options.json, job, result, info, title, std::move(files), launch.estimates());
}

}  // namespace glint::app
