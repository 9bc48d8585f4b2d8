// Builds a world from a description.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/pipeline_world.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <span>
#include <tuple>
#include <utility>

#include "exec/block.h"
#include "isa/descriptors.h"
#include "pipeline/description/data.h"
#include "pipeline/description/mesh.h"
#include "pipeline/description/pictures.h"
#include "pipeline/launch_size.h"
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

std::string title(const std::string& name, const Slot& slot) {
  return slot.is_bound() ? fmt::format("set {} binding {} ({})", slot.set.value_or(0), *slot.binding, name)
                         : name;
}

}  // namespace

PipelineWorld::PipelineWorld(const PipelineDescription& description, const GpuParams& gpu)
    : description_(description), modules_(description_, compiler_for(gpu)) {
  warnings = modules_.warnings;
  check_pipeline(description_, modules_, warnings);
  world.memory = &memory_;
  world.constant_bank.resize(isa::kConstantBankBytes);
  world.nearest_first_hit = gpu.rt.nearest_first_hit;
  world.any_hit = gpu.rt.any_hit.make({});
  world.layout = gpu.core.layout.make({});
  link(gpu);
  set_launch();
  upload_buffers();
  upload_images();
  add_samplers();
  build_structures(gpu);
  for (const auto& [place, use] :
       modules_.bindings())  // bindings that no code uses; check_pipeline() refuses the others
    if (!bound_.count(place)) mark_unbound(world, use.binding);
  if (description_.raygen) fill_records();
  set_push_constants();
  errors_.throw_if_errors();
}

void PipelineWorld::link(const GpuParams& gpu) {
  std::vector<isa::Program> programs;
  for (const ShaderModule& module : modules_.all()) programs.push_back(module.program);
  add_traversal(programs, gpu, description_.shaders.empty() ? nullptr : description_.shaders[0].glsl.cache);
  image_ = exec::link(programs);
  world.image = &image_;
  const bool nested =
      traces_from(modules_, isa::Stage::ClosestHit) || traces_from(modules_, isa::Stage::Miss);
  world.max_trace_depth = description_.max_trace_depth.value_or(nested ? kDefaultDepth : 1);
  const bool has_callables = !description_.callable.records.empty();
  world.max_callable_depth = description_.max_callable_depth.value_or(has_callables ? kDefaultDepth : 0);
  world.local_bytes = stack_bytes(image_, world.max_trace_depth, world.max_callable_depth);
}

void PipelineWorld::set_launch() {
  if (description_.compute.empty()) {
    check_launch_size(description_.launch, {1, 1, 1}, SourceLocation{description_.path});
    world.launch_size = description_.launch;
    return;
  }
  world.raygen = modules_.index_of(description_.compute);
  const isa::Program& program = modules_.find(description_.compute).program;
  const auto& size = program.local_size;
  if (uint64_t{size[0]} * size[1] * size[2] > exec::kMaxBlockThreads)
    throw UserError(description_.compute_where,
                    fmt::format("'{}' has blocks of {} x {} x {} threads, and at most {} are possible",
                                description_.compute, size[0], size[1], size[2], exec::kMaxBlockThreads));
  check_launch_size(description_.launch, size, description_.compute_where);
  exec::set_blocks(world, description_.launch, size, program.shared_bytes);
}

const BindingUse* PipelineWorld::use_of(const Slot& slot) const {
  if (!slot.is_bound()) return nullptr;
  const auto found = modules_.bindings().find({slot.set.value_or(0), *slot.binding});
  return found == modules_.bindings().end() ? nullptr : &found->second;
}

void PipelineWorld::bind(const Slot& slot, uint64_t address_or_handle, uint64_t bytes_or_count) {
  if (!slot.is_bound()) return;
  bound_.insert({slot.set.value_or(0), *slot.binding});
  write_descriptor(world, {slot.set.value_or(0), *slot.binding}, address_or_handle, bytes_or_count);
}

// Binds one element. By docs/abi.md, arrays of buffers and of acceleration structures have their descriptors
// in a table in global memory.
void PipelineWorld::bind_table(const Slot& slot, uint32_t element, uint64_t address, uint64_t bytes) {
  const BindingUse* use = use_of(slot);
  if (!use || use->binding.count == 1) return bind(slot, address, bytes);
  const std::pair place{slot.set.value_or(0), *slot.binding};
  const auto [it, is_new] = tables_.try_emplace(place, 0);
  if (is_new) {
    uint32_t count = use->binding.count;
    const auto count_in = [&](const auto& resources) {
      for (const auto& r : resources)
        if (r.slot.is_bound() && std::pair(r.slot.set.value_or(0), *r.slot.binding) == place)
          count = std::max(count, r.slot.element + 1);
    };
    count_in(description_.buffers);
    count_in(description_.top_levels);
    it->second = memory_.allocate(fmt::format("descriptors of set {} binding {}", place.first, place.second),
                                  uint64_t{count} * isa::kDescriptorBytes);
    bind(slot, it->second, count);
  }
  const uint64_t descriptor[2] = {address, bytes};
  memory_.write(it->second + uint64_t{element} * isa::kDescriptorBytes, descriptor, sizeof(descriptor));
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
  for (size_t i = 0; i < description_.buffers.size(); ++i) {
    const BufferDescription& b = description_.buffers[i];
    const std::vector<std::byte> bytes = bytes_of(
        b.data, block_of(b), [&](const std::string& name) { return address_of(name); }, errors_);
    if (!bytes.empty()) memory_.write(buffer_address_[i], bytes.data(), bytes.size());
    bind_table(b.slot, b.slot.element, buffer_address_[i], bytes.size());
  }
}

// Returns resources ordered by set, binding and element, because images and samplers of an array have
// consecutive numbers.
std::vector<size_t> PipelineWorld::in_order(const std::vector<const Slot*>& slots) const {
  std::vector<size_t> order(slots.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return std::tuple(slots[a]->set, slots[a]->binding, slots[a]->element) <
           std::tuple(slots[b]->set, slots[b]->binding, slots[b]->element);
  });
  return order;
}

void PipelineWorld::upload_images() {
  std::vector<const Slot*> slots;
  for (const ImageDescription& image : description_.images) slots.push_back(&image.slot);
  image_handle_.resize(slots.size());
  for (size_t i : in_order(slots)) {
    const ImageDescription& d = description_.images[i];
    const BindingUse* use = use_of(d.slot);
    if (use && d.samples > 1 && !use->binding.multisampled)
      throw UserError(d.where, fmt::format("image '{}' has {} samples per texel, and the shader's has one",
                                           d.name, d.samples));
    Picture picture =
        make_picture(d, use ? use->binding.shape : isa::ImageShape::D2, use ? use->binding.texel : "",
                     world.launch_size, use ? use->binding.format : "");
    picture.view.base = memory_.allocate(title(d.name, d.slot), picture.texels.size());
    memory_.write(picture.view.base, picture.texels.data(), picture.texels.size());
    image_handle_[i] = world.images.size();
    if (d.slot.element == 0) bind(d.slot, image_handle_[i], use ? std::max(1u, use->binding.count) : 1);
    world.images.push_back(std::move(picture.view));
  }
}

void PipelineWorld::add_samplers() {
  std::vector<const Slot*> slots;
  for (const SamplerDescription& sampler : description_.samplers) slots.push_back(&sampler.slot);
  for (size_t i : in_order(slots)) {
    if (slots[i]->element == 0) bind(*slots[i], world.samplers.size(), 1);
    world.samplers.push_back(description_.samplers[i].sampler);
  }
}

void PipelineWorld::build_structures(const GpuParams& gpu) {
  std::vector<rt::StructureInfo> bottoms;
  for (const BottomLevelDescription& description : description_.bottom_levels) {
    rt::BottomLevel level;
    std::vector<scenes::Model> models;
    models.reserve(description.geometries.size());  // Geometries point into them.
    for (const GeometryDescription& g : description.geometries) {
      rt::Geometry geometry;
      geometry.transform = g.transform, geometry.opaque = g.opaque,
      geometry.no_duplicate_any_hit = g.no_duplicate_any_hit;
      if (!g.mesh.empty()) {
        models.push_back(load_mesh(g.mesh, g.where));
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
      structures.triangles += geometry.indices.empty() ? geometry.positions.size() / geometry.stride / 3
                                                       : geometry.indices.size() / 3;
      level.geometries.push_back(geometry);
    }
    bottoms.push_back(rt::build_bottom(memory_, "bottom level " + description.name, level, gpu.bvh));
    structures.bytes += bottoms.back().bytes;
    structures.bottom_depth = std::max(structures.bottom_depth, bottoms.back().depth);
  }
  structures.bottom_levels = bottoms.size();
  uint32_t stack_need = 0;
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
    if (description.slot.is_bound())
      bind_table(description.slot, description.slot.element, top.address, top.bytes);
  }
  place_records(world, stack_need);
}

uint32_t PipelineWorld::group_index(const GroupDescription& group, TableInput& input, bool is_hit) {
  if (!is_hit && group.general.empty()) return kNoGroup;
  ShaderGroup made;
  made.general = modules_.index_of(group.general);
  made.hit = {modules_.index_of(group.closest_hit), modules_.index_of(group.any_hit),
              modules_.index_of(group.intersection)};
  input.groups.push_back(made);
  return uint32_t(input.groups.size() - 1);
}

TableRecord PipelineWorld::record(const RecordDescription& description, TableInput& input, bool is_hit) {
  const GroupDescription* group = &description.inlined;
  for (const GroupDescription& named : description_.groups)
    if (!description.group.empty() && named.name == description.group) group = &named;
  TableRecord out;
  out.group = group_index(*group, input, is_hit);
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

void PipelineWorld::fill_records() {
  TableInput input;
  input.raygen = record(*description_.raygen, input, false);
  const auto fill = [&](TableRegion& to, const RegionDescription& from, bool is_hit) {
    to.stride = from.stride;
    for (const RecordDescription& each : from.records) to.records.push_back(record(each, input, is_hit));
  };
  fill(input.miss, description_.miss, false);
  fill(input.hit, description_.hit, true);
  fill(input.callable, description_.callable, false);
  errors_.throw_if_errors();
  build_binding_table(world, memory_, input);
}

void PipelineWorld::set_push_constants() {
  const frontend::BlockType* block = nullptr;
  const ShaderModule* reader = nullptr;
  for (const ShaderModule& module : modules_.all())
    if (!module.reflection.push_constants.members.empty() &&
        (!block || module.reflection.push_constants.bytes > block->bytes))
      block = &module.reflection.push_constants, reader = &module;
  if (!description_.push_constants.data) {
    if (block)
      errors_.error({description_.path, 0, 0}, "[push_constants] is missing",
                    fmt::format("the shader declares {} bytes of them at {}", block->bytes,
                                reader->where_declared("push_constant").to_string()));
    return;
  }
  const std::vector<std::byte> bytes = bytes_of(
      description_.push_constants, block, [&](const std::string& name) { return address_of(name); }, errors_);
  const uint64_t room = isa::kConstantBankBytes - isa::kPushConstantOffset;
  if (bytes.size() > room)
    errors_.error(
        description_.push_constants.where,
        fmt::format("{} bytes of push constants do not fit: there is room for {}", bytes.size(), room));
  else if (block && bytes.size() < block->bytes)
    errors_.error(
        description_.push_constants.where,
        fmt::format("the push constants have {} bytes, and the shader's have {}", bytes.size(), block->bytes),
        fmt::format("the shader declares them at {}", reader->where_declared("push_constant").to_string()));
  else
    std::memcpy(world.constant_bank.data() + isa::kPushConstantOffset, bytes.data(), bytes.size());
}

std::span<const std::byte> PipelineWorld::buffer(size_t index) const {
  return {memory_.find(buffer_address_[index], buffer_bytes_[index]), size_t(buffer_bytes_[index])};
}

RenderResult run_pipeline(PipelineWorld& pipeline, const GpuParams& gpu, bool timing, bool no_skip,
                          uint32_t threads, const LaunchWatch& watch, const Observation& observe) {
  RenderResult result = run_world(pipeline.world, gpu, timing, no_skip, threads, watch, observe);
  result.structures = pipeline.structures;
  result.warnings = pipeline.warnings;
  return result;
}

}  // namespace glint::pipeline
