// Builds a world from a description.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/pipeline_world.h"

#include <algorithm>
#include <fmt/format.h>
#include <span>
#include <tuple>
#include <utility>

#include "pipeline/description/data.h"
#include "pipeline/description/mesh.h"
#include "pipeline/description/pictures.h"
#include "pipeline/level_micromaps.h"
#include "pipeline/software_traversal.h"

namespace glint::pipeline {
namespace {

// Choice: pipelines whose hit and miss shaders trace get room for eight nested rays, unless they say how
// many.
constexpr uint32_t kDefaultDepth = 8;

bool traces_from(const Modules& modules, isa::Stage stage) {
  return std::any_of(modules.all().begin(), modules.all().end(), [&](const ShaderModule& m) {
    return m.reflection.stage == stage && m.reflection.largest_payload_bytes > 0;
  });
}

std::vector<frontend::Binding> bindings_of(const Modules& modules) {
  std::vector<frontend::Binding> out;
  for (const auto& [place, use] : modules.bindings()) out.push_back(use.binding);
  return out;
}

// Collects the elements of bindings, which a description gives one by one.
template <class Resource>
struct Elements {
  std::vector<std::pair<BindingPlace, std::vector<Resource>>> all;  // in the order of their first elements

  void add(const Slot& slot, Resource resource, Resource (*none)(BindingPlace)) {
    if (!slot.is_bound()) return;
    const BindingPlace place{slot.set.value_or(0), *slot.binding};
    auto at = std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.first == place; });
    if (at == all.end()) at = all.insert(at, {place, {}});
    if (at->second.size() <= slot.element) at->second.resize(slot.element + 1, none(place));
    at->second[slot.element] = std::move(resource);
  }
};

// Returns images ordered by set, binding and element, in which they lie in memory.
std::vector<size_t> in_order(const std::vector<ImageDescription>& images) {
  std::vector<size_t> order(images.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto key = [&](size_t i) {
    const Slot& slot = images[i].slot;
    return std::tuple(slot.set, slot.binding, slot.element);
  };
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return key(a) < key(b); });
  return order;
}

std::string title(const std::string& name, const Slot& slot) {
  return slot.is_bound() ? fmt::format("set {} binding {} ({})", slot.set.value_or(0), *slot.binding, name)
                         : name;
}

}  // namespace

PipelineWorld::PipelineWorld(const PipelineDescription& description, const GpuParams& gpu, uint32_t threads)
    : description_(description), modules_(description_, compiler_for(gpu)) {
  warnings = modules_.warnings;
  check_pipeline(description_, modules_, warnings);
  for (const LaunchDescription& launch : description_.launches) link(launch, gpu);
  for (const Built& launch : launches_) set_size(launch);
  upload_buffers();
  upload_images(threads);
  add_samplers();
  add_filter(gpu);
  const uint32_t stack_need = build_structures(gpu, threads);
  for (const Built& launch : launches_) {
    if (launch.description.raygen) fill_records(launch);
    set_push_constants(launch);
  }
  errors_.throw_if_errors();
  // Only bindings that no code uses are left, because check_pipeline() refuses the others.
  for (const Built& launch : launches_) launch.builder->finish(stack_need);
}

// A file with one launch links every shader that it names.
bool PipelineWorld::uses(const LaunchDescription& launch, const ShaderModule& module) const {
  if (description_.launches.size() == 1) return true;
  const isa::Stage stage = module.reflection.stage;
  if (!launch.compute.empty()) return module.name == launch.compute;
  if (stage != isa::Stage::RayGeneration) return stage != isa::Stage::Compute;
  const RecordDescription& raygen = *launch.raygen;
  if (raygen.group.empty()) return module.name == raygen.inlined.general;
  return std::any_of(description_.groups.begin(), description_.groups.end(), [&](const auto& group) {
    return group.name == raygen.group && group.general == module.name;
  });
}

void PipelineWorld::link(const LaunchDescription& launch, const GpuParams& gpu) {
  Built built{launch, {}, {}, {}};
  std::vector<isa::Program> programs;
  for (const ShaderModule& module : modules_.all()) {
    const bool is_used = uses(launch, module);
    built.number.push_back(is_used ? uint32_t(programs.size()) : exec::kNoShader);
    if (is_used) programs.push_back(module.program);
  }
  frontend::ShaderCache* const cache =
      description_.shaders.empty() ? nullptr : description_.shaders[0].glsl.cache;
  built.shaders =
      std::make_unique<const LinkedShaders>(std::move(programs), bindings_of(modules_), gpu, cache);
  built.builder = std::make_unique<LaunchBuilder>(*built.shaders, memory_);
  launches_.push_back(std::move(built));
}

uint32_t PipelineWorld::number_of(const Built& launch, const std::string& shader) const {
  const uint32_t module = modules_.index_of(shader);
  return module == exec::kNoShader ? exec::kNoShader : launch.number[module];
}

void PipelineWorld::set_size(const Built& launch) {
  const LaunchDescription& d = launch.description;
  if (!d.compute.empty()) return launch.builder->set_blocks(number_of(launch, d.compute), d.size, d.where);
  const bool nested =
      traces_from(modules_, isa::Stage::ClosestHit) || traces_from(modules_, isa::Stage::Miss);
  const bool has_callables = !description_.callable.records.empty();
  launch.builder->set_rays(d.size, d.max_trace_depth.value_or(nested ? kDefaultDepth : 1),
                           d.max_callable_depth.value_or(has_callables ? kDefaultDepth : 0), d.where);
}

const BindingUse* PipelineWorld::use_of(const Slot& slot) const {
  if (!slot.is_bound()) return nullptr;
  const auto found = modules_.bindings().find({slot.set.value_or(0), *slot.binding});
  return found == modules_.bindings().end() ? nullptr : &found->second;
}

uint64_t PipelineWorld::address_of(const std::string& buffer) const {
  for (size_t i = 0; i < buffer_address_.size(); ++i)
    if (description_.buffers[i].name == buffer) return buffer_address_[i];
  return 0;
}

// Gives out all addresses before it fills any buffer, so that buffers can point to each other. It first
// computes sizes, with any address that is not 0.
void PipelineWorld::upload_buffers() {
  const auto block_of = [&](const BufferDescription& b) {
    const BindingUse* use = use_of(b.slot);
    return use ? &use->binding.block : nullptr;
  };
  for (const BufferDescription& b : description_.buffers) {
    const auto known = [&](const std::string& name) {
      return uint64_t(std::any_of(description_.buffers.begin(), description_.buffers.end(),
                                  [&](const auto& other) { return other.name == name; }));
    };
    const uint64_t bytes = bytes_of(b.data, block_of(b), known, errors_).size();
    if (const BindingUse* use = use_of(b.slot)) check_bytes(*use, bytes, b.name, b.where, errors_);
    buffer_bytes_.push_back(bytes);
    buffer_address_.push_back(memory_.allocate(title(b.name, b.slot), std::max<uint64_t>(bytes, 4)));
  }
  errors_.throw_if_errors();
  Elements<BufferRange> bound;
  for (size_t i = 0; i < description_.buffers.size(); ++i) {
    const BufferDescription& b = description_.buffers[i];
    const std::vector<std::byte> bytes = bytes_of(
        b.data, block_of(b), [&](const std::string& name) { return address_of(name); }, errors_);
    if (!bytes.empty()) memory_.write(buffer_address_[i], bytes.data(), bytes.size());
    bound.add(b.slot, {buffer_address_[i], bytes.size()}, LaunchBuilder::unbound);
  }
  for (const Built& launch : launches_)
    for (const auto& [place, elements] : bound.all) launch.builder->bind_buffers(place, elements);
}

void PipelineWorld::upload_images(uint32_t threads) {
  const std::vector<ImageDescription>& all = description_.images;
  images_.resize(all.size());
  Elements<exec::ImageView> bound;
  const PictureMaker maker(all, threads);
  for (size_t i : in_order(all)) {
    const ImageDescription& d = all[i];
    const BindingUse* use = use_of(d.slot);
    if (use && d.samples > 1 && !use->binding.multisampled)
      throw UserError(d.where, fmt::format("image '{}' has {} samples per texel, and the shader's has one",
                                           d.name, d.samples));
    DeclaredImage declared;
    if (use) declared = {use->binding.shape, use->binding.texel, use->binding.format};
    Picture picture = maker.make(d, declared, world().launch_size);
    picture.view.base = memory_.allocate(title(d.name, d.slot), picture.texels.size());
    memory_.write(picture.view.base, picture.texels.data(), picture.texels.size());
    images_[i] = picture.view;
    bound.add(d.slot, std::move(picture.view), unbound_image);
  }
  for (const Built& launch : launches_)
    for (const auto& [place, elements] : bound.all) launch.builder->bind_images(place, elements);
}

void PipelineWorld::add_samplers() {
  Elements<exec::Sampler> bound;
  for (const SamplerDescription& d : description_.samplers) bound.add(d.slot, d.sampler, unbound_sampler);
  for (const Built& launch : launches_)
    for (const auto& [place, elements] : bound.all) launch.builder->bind_samplers(place, elements);
}

namespace {

uint64_t triangles_of(const rt::Geometry& geometry) {
  return geometry.indices.empty() ? geometry.positions.size() / geometry.stride / 3
                                  : geometry.indices.size() / 3;
}

// Returns the maps of a geometry that has so many triangles.
TakenMicromaps maps_of(const OpacityDescription& from, uint64_t triangles) {
  TakenMicromaps out;
  out.index = from.index;
  if (out.index.empty())
    for (size_t i = 0; i < from.maps.size(); ++i) out.index.push_back(int32_t(i));
  if (out.index.size() != triangles)
    throw UserError(from.where,
                    fmt::format("the opacity maps are those of {} triangles, and the geometry has {}",
                                out.index.size(), triangles));
  for (const OpacityDescription::Map& each : from.maps)
    out.maps.push_back({each.format, std::as_bytes(std::span(each.states))});
  return out;
}

}  // namespace

// Lets rays ask the leaf filter that the configuration chooses. Maps that nobody asks are a mistake.
void PipelineWorld::add_filter(const GpuParams& gpu) {
  if (gpu.rt.leaf_filter.name != rt::LeafFilter::kNone) {
    for (const Built& launch : launches_)
      launch.builder->world.filter = gpu.rt.leaf_filter.make({nullptr, memory_});
    return;
  }
  for (const BottomLevelDescription& level : description_.bottom_levels)
    for (const GeometryDescription& each : level.geometries)
      if (each.opacity)
        throw UserError(each.opacity->where,
                        "the geometry has opacity maps, and rt.leaf_filter = \"none\" asks none",
                        "choose rt.leaf_filter = \"micromaps\", with --set or in [machine]");
}

uint32_t PipelineWorld::build_structures(const GpuParams& gpu, uint32_t threads) {
  std::vector<rt::StructureInfo> bottoms;
  for (const BottomLevelDescription& description : description_.bottom_levels) {
    rt::BottomLevel level;
    LevelMicromaps micromaps;
    std::vector<scenes::Model> models;
    models.reserve(description.geometries.size());  // Geometries point into them.
    for (const GeometryDescription& g : description.geometries) {
      rt::Geometry geometry;
      geometry.transform = g.transform, geometry.opaque = g.opaque,
      geometry.no_duplicate_any_hit = g.no_duplicate_any_hit;
      if (!g.mesh.empty()) {
        models.push_back(load_mesh(g.mesh, g.where, threads));
        geometry.positions = std::as_bytes(std::span(models.back().vertices));
        geometry.stride = sizeof(scenes::Vertex);
        geometry.indices = models.back().indices;
      } else if (!g.aabbs.empty()) {
        geometry.aabbs = g.aabbs;
      } else {
        geometry.positions = std::as_bytes(std::span(g.vertices));
        geometry.indices = g.indices;
      }
      structures.procedurals += g.aabbs.size();
      const uint64_t triangles = triangles_of(geometry);
      structures.triangles += triangles;
      if (g.opacity) micromaps.add(level.geometries.size(), maps_of(*g.opacity, triangles));
      level.geometries.push_back(geometry);
    }
    micromaps.give_to(level);
    bottoms.push_back(rt::build_bottom(memory_, "bottom level " + description.name, level, gpu.bvh, threads));
    structures.bytes += bottoms.back().bytes;
    structures.bottom_depth = std::max(structures.bottom_depth, bottoms.back().depth);
  }
  structures.bottom_levels = bottoms.size();
  uint32_t stack_need = 0;
  Elements<BufferRange> bound;
  for (const TopLevelDescription& description : description_.top_levels) {
    std::vector<rt::Instance> instances;
    for (const InstanceDescription& d : description.instances) {
      rt::Instance instance = d.instance;
      for (size_t i = 0; i < bottoms.size(); ++i)
        if (description_.bottom_levels[i].name == d.bottom_level) instance.bottom = uint32_t(i);
      const std::string why = rt::why_unreachable(instance, bottoms.at(instance.bottom));
      if (!why.empty())
        throw UserError(d.where,
                        fmt::format("no ray can meet this instance of '{}': {}", d.bottom_level, why));
      instances.push_back(instance);
    }
    const rt::StructureInfo top =
        rt::build_top(memory_, title(description.name, description.slot), instances, bottoms, gpu.bvh);
    stack_need = std::max(stack_need, top.stack_need);
    structures.bytes += top.bytes;
    structures.instances += instances.size();
    structures.top_depth = std::max(structures.top_depth, top.depth);
    bound.add(description.slot, {top.address, top.bytes}, LaunchBuilder::unbound);
  }
  for (const Built& launch : launches_)
    for (const auto& [place, elements] : bound.all) launch.builder->bind_buffers(place, elements);
  return stack_need;
}

uint32_t PipelineWorld::group_index(const Built& launch, const GroupDescription& group, TableInput& input,
                                    bool is_hit) {
  if (!is_hit && group.general.empty()) return kNoGroup;
  ShaderGroup made;
  made.general = number_of(launch, group.general);
  made.hit = {number_of(launch, group.closest_hit), number_of(launch, group.any_hit),
              number_of(launch, group.intersection)};
  input.groups.push_back(made);
  return uint32_t(input.groups.size() - 1);
}

TableRecord PipelineWorld::record(const Built& launch, const RecordDescription& description,
                                  TableInput& input, bool is_hit) {
  const GroupDescription* group = &description.inlined;
  for (const GroupDescription& named : description_.groups)
    if (!description.group.empty() && named.name == description.group) group = &named;
  TableRecord out;
  out.group = group_index(launch, *group, input, is_hit);
  const frontend::BlockType* block = nullptr;
  const ShaderModule* reader = nullptr;
  for (const std::string& name : {group->general, group->closest_hit, group->any_hit, group->intersection}) {
    if (name.empty() || modules_.find(name).reflection.shader_record.members.empty()) continue;
    const frontend::BlockType& found = modules_.find(name).reflection.shader_record;
    if (!block || found.bytes > block->bytes) block = &found, reader = &modules_.find(name);
  }
  out.data = bytes_of(
      description.data, block, [&](const std::string& name) { return address_of(name); }, errors_);
  if (!block || out.data.size() >= block->bytes) return out;
  errors_.error(
      description.where,
      fmt::format("the record's data have {} bytes, and the shader's record has {}", out.data.size(),
                  block->bytes),
      fmt::format("the shader declares it at {}", reader->where_declared("shaderRecord").to_string()));
  return out;
}

void PipelineWorld::fill_records(const Built& launch) {
  TableInput input;
  input.raygen = record(launch, *launch.description.raygen, input, false);
  const auto fill = [&](TableRegion& to, const RegionDescription& from, bool is_hit) {
    to.stride = from.stride, to.where = from.stride_where;
    for (const RecordDescription& each : from.records)
      to.records.push_back(record(launch, each, input, is_hit));
    const auto larger = [](const TableRecord& a, const TableRecord& b) {
      return a.data.size() < b.data.size();
    };
    const auto largest = std::max_element(to.records.begin(), to.records.end(), larger);
    if (!to.stride && largest != to.records.end())
      to.where = from.records[size_t(largest - to.records.begin())].where;
  };
  fill(input.miss, description_.miss, false);
  fill(input.hit, description_.hit, true);
  fill(input.callable, description_.callable, false);
  errors_.throw_if_errors();
  launch.builder->set_records(input);
}

void PipelineWorld::set_push_constants(const Built& launch) {
  const DataSource& given = launch.description.push_constants;
  const frontend::BlockType* block = nullptr;
  const ShaderModule* reader = nullptr;
  for (const ShaderModule& module : modules_.all())
    if (number_of(launch, module.name) != exec::kNoShader &&
        !module.reflection.push_constants.members.empty() &&
        (!block || module.reflection.push_constants.bytes > block->bytes))
      block = &module.reflection.push_constants, reader = &module;
  if (!given.data) {
    if (block)
      errors_.error({description_.path, 0, 0}, "[push_constants] is missing",
                    fmt::format("the shader declares {} bytes of them at {}", block->bytes,
                                reader->where_declared("push_constant").to_string()));
    return;
  }
  const std::vector<std::byte> bytes = bytes_of(
      given, block, [&](const std::string& name) { return address_of(name); }, errors_);
  if (block && bytes.size() < block->bytes)
    errors_.error(
        given.where,
        fmt::format("the push constants have {} bytes, and the shader's have {}", bytes.size(), block->bytes),
        fmt::format("the shader declares them at {}", reader->where_declared("push_constant").to_string()));
  else
    launch.builder->set_push_constants(bytes, 0, given.where);
}

std::span<const std::byte> PipelineWorld::buffer(size_t index) const {
  return {memory_.find(buffer_address_[index], buffer_bytes_[index]), size_t(buffer_bytes_[index])};
}

}  // namespace glint::pipeline
