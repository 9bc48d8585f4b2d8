// Makes the world of a launch that a capsule holds.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/capsule/capsule_world.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/format.h>
#include <span>
#include <utility>
#include <variant>

#include "isa/stage.h"
#include "pipeline/capsule/save_memory.h"
#include "pipeline/software_traversal.h"

namespace glint::pipeline {
namespace {

rt::BottomLevel level_of(const StructureInputs& inputs) {
  rt::BottomLevel out;
  for (const StructureInputs::Geometry& each : inputs.geometries) {
    rt::Geometry& to = out.geometries.emplace_back();
    to.positions = std::as_bytes(std::span(each.positions));
    to.indices = each.indices, to.aabbs = each.boxes, to.transform = each.transform;
    to.opaque = each.opaque, to.no_duplicate_any_hit = each.no_duplicate_any_hit;
    to.micromaps = each.micromaps ? &*each.micromaps : nullptr;
  }
  return out;
}

}  // namespace

std::shared_ptr<const StructureInputs> inputs_of(const rt::BottomLevel& level) {
  auto out = std::make_shared<StructureInputs>();
  for (const rt::Geometry& each : level.geometries) {
    StructureInputs::Geometry& to = out->geometries.emplace_back();
    for (uint64_t at = 0; at + sizeof(float) * 3 <= each.positions.size(); at += each.stride) {
      std::array<float, 3> corner;
      std::memcpy(corner.data(), each.positions.data() + at, sizeof corner);
      to.positions.insert(to.positions.end(), corner.begin(), corner.end());
    }
    to.indices.assign(each.indices.begin(), each.indices.end());
    to.boxes.assign(each.aabbs.begin(), each.aabbs.end());
    to.transform = each.transform, to.opaque = each.opaque;
    to.no_duplicate_any_hit = each.no_duplicate_any_hit;
    if (each.micromaps) to.micromaps = *each.micromaps;
  }
  return out;
}

std::string structure_format(const rt::BuildOptions& options) {
  return fmt::format("format={} pair_triangles={} layout={}", options.format.name, options.pair_triangles,
                     options.layout.name);
}

CapsuleWorld::CapsuleWorld(const Capsule& capsule, const GpuParams& gpu, frontend::ShaderCache* cache)
    : capsule_(capsule) {
  if (capsule.has_micromaps && gpu.rt.unit == rt::kSoftware)
    throw UserError({},
                    "the application uses opacity micromaps, which rays that are walked in code do not see",
                    "choose another rt.unit");
  compile(gpu, cache);
  restore_memory(capsule.memory, memory_);
  build_structures(gpu);
  builder_ = std::make_unique<LaunchBuilder>(*shaders_, memory_);
  bind();
  builder_->set_push_constants(capsule.push_constants);
  builder_->world.robust_buffers = capsule.robust_buffers;
  builder_->world.robust_images = capsule.robust_images;
  if (capsule.has_micromaps) builder_->world.filter = gpu.rt.leaf_filter.make({nullptr, memory_});
  if (capsule.rays) {
    set_rays(*capsule.rays);
  } else {
    builder_->set_blocks(0, capsule.size, {capsule.shader, 0, 0});
    exec::set_first_block(builder_->world, capsule.base);
  }
  builder_->finish(gpu.rt.unit == rt::kSoftware ? stack_need() : 0);
}

void CapsuleWorld::compile(const GpuParams& gpu, frontend::ShaderCache* cache) {
  if (capsule_.stages.empty()) throw UserError("a capsule has no shaders");
  std::vector<isa::Program> programs;
  std::vector<frontend::Binding> bindings;
  Diagnostics unread;
  for (const Capsule::Stage& each : capsule_.stages) {
    CompiledStage made =
        compile_stage(each.words, {each.name, each.entry, each.constants, frontend::Validity::Known},
                      compiler_for(gpu), unread, cache);
    if (uint32_t(made.program.stage) != each.stage)
      throw UserError(fmt::format("entry point '{}' of {} is of another stage than the capsule says",
                                  each.entry, each.name));
    programs.push_back(std::move(made.program));
    bindings.insert(bindings.end(), made.reflection.bindings.begin(), made.reflection.bindings.end());
  }
  shaders_ = std::make_unique<const LinkedShaders>(std::move(programs), bindings, gpu, cache);
}

void CapsuleWorld::build_structures(const GpuParams& gpu) {
  if (capsule_.structures.empty() || structure_format(gpu.bvh) == capsule_.structure_format) return;
  is_rebuilt_ = true;
  for (const bool is_top : {false, true})  // A top level reads its bottom levels.
    for (const PlacedStructure& each : capsule_.structures) {
      if (!each.inputs)
        throw UserError({},
                        fmt::format("'{}' was deserialised, so it cannot be built for {}", each.name,
                                    structure_format(gpu.bvh)),
                        "use a configuration with " + capsule_.structure_format);
      if (each.inputs->is_top == is_top) build_structure(each, gpu.bvh);
    }
}

void CapsuleWorld::build_structure(const PlacedStructure& structure, const rt::BuildOptions& options) {
  const StructureInputs& inputs = *structure.inputs;
  rt::EncodedStructure made;
  if (inputs.is_top) {
    std::vector<rt::DeviceInstance> instances = inputs.instances;
    for (rt::DeviceInstance& each : instances)
      if (const auto found = moved_.find(each.structure); found != moved_.end())
        each.structure = found->second;
    made = rt::encode_top(memory_, structure.name, instances, options, notes);
  } else {
    made = rt::encode_bottom(structure.name, level_of(inputs), options);
  }
  Address at = structure.address;
  if (made.bytes.size() > structure.room)
    at = moved_[structure.address] = memory_.allocate(structure.name, made.bytes.size());
  rt::write_structure(memory_, made, at);
}

void CapsuleWorld::bind() {
  for (const BoundResources& each : capsule_.bindings) {
    if (const auto* images = std::get_if<std::vector<exec::ImageView>>(&each.elements))
      builder_->bind_images(each.place, *images);
    if (const auto* samplers = std::get_if<std::vector<exec::Sampler>>(&each.elements))
      builder_->bind_samplers(each.place, *samplers);
    if (const auto* buffers = std::get_if<std::vector<BufferRange>>(&each.elements)) {
      std::vector<BufferRange> all = *buffers;
      for (BufferRange& one : all)
        if (const auto found = moved_.find(one.address); found != moved_.end() && one.bytes == 0)
          one.address = found->second;
      builder_->bind_buffers(each.place, all);
    }
  }
}

void CapsuleWorld::set_rays(const Capsule::Rays& rays) {
  const size_t stages = capsule_.stages.size();
  const auto is_wrong = [stages](uint32_t shader) { return shader != exec::kNoShader && shader >= stages; };
  for (const ShaderGroup& each : rays.groups)
    if (is_wrong(each.general) || is_wrong(each.hit.closest_hit) || is_wrong(each.hit.any_hit) ||
        is_wrong(each.hit.intersection))
      throw UserError("a shader group of a capsule names a stage that it lacks");
  builder_->set_rays(capsule_.size, rays.max_trace_depth, rays.default_callable_depth,
                     {capsule_.shader, 0, 0});
  exec::World& world = builder_->world;
  world.max_callable_depth = rays.max_callable_depth, world.added_ray_flags = rays.added_flags;
  if (rays.stack_bytes)
    world.local_bytes =
        std::min(*rays.stack_bytes, stack_bytes(*world.image, rays.max_trace_depth, rays.max_callable_depth));
  read_binding_table(world, memory_, rays.table, rays.groups, rays.pipeline);
}

uint32_t CapsuleWorld::stack_need() const {
  uint32_t most = is_rebuilt_ ? 0 : capsule_.stack_need;
  for (const PlacedStructure& each : capsule_.structures) {
    const auto moved = moved_.find(each.address);
    if (const auto info = rt::structure_at(memory_, moved == moved_.end() ? each.address : moved->second))
      most = std::max(most, info->stack_need);
  }
  return most;
}

}  // namespace glint::pipeline
