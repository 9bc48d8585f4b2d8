// Runs a launch on the simulated GPU with what a command buffer has bound.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/launch.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <utility>
#include <vector>

#include "exec/print_log.h"
#include "pipeline/capsule/save_memory.h"
#include "pipeline/launch_builder.h"
#include "vulkan/bound_descriptors.h"
#include "vulkan/device.h"
#include "vulkan/pipeline.h"
#include "vulkan/run_launch.h"

namespace glint::vulkan {
namespace {

constexpr uint32_t kDefaultCallableDepth = 2, kMaxCallableDepth = 31;

// Frees what the builder has allocated and, when they are many, parts of buffers, also when the launch ends
// with an exception.
class Allocations {
 public:
  Allocations(Device& device, const pipeline::LaunchBuilder& builder)
      : memory_(device.memory), parts_(device.parts), builder_(builder) {}
  ~Allocations() {
    for (const Address each : builder_.allocations()) memory_.free(each);
    parts_.trim(memory_);
  }
  Allocations(const Allocations&) = delete;
  Allocations& operator=(const Allocations&) = delete;

 private:
  mem::AddressSpace& memory_;
  BufferParts& parts_;
  const pipeline::LaunchBuilder& builder_;
};

// Describes a launch but for its size and its memory.
void begin_capsule(pipeline::Capsule& capsule, Device& device, const Bindings& bound,
                   const exec::World& world) {
  const std::vector<isa::Program>& programs = world.image->programs;
  BindingNumbers numbers = bound.pipeline->binding_numbers();
  for (size_t i = 0; i < bound.pipeline->stages.size(); ++i) {
    const PipelineStage& each = bound.pipeline->stages[i];
    capsule.stages.push_back({each.name, each.entry_point, uint32_t(programs.at(i).stage), each.constants,
                              numbers.changed(*each.words)});
  }
  capsule.push_constants.assign(bound.push_constants.begin(), bound.push_constants.end());
  capsule.robust_buffers = world.robust_buffers, capsule.robust_images = world.robust_images;
  capsule.has_micromaps = device.has("micromap");
  capsule.structure_format = pipeline::structure_format(device.physical.gpu.bvh);
  capsule.stack_need = stack_need(device);
  std::map<Address, const Structure*> newest;  // Several structures may have been built at one address.
  for (const Structure* const each : device.structures) {
    const Structure*& kept = newest[each->address];
    if (each->built && (!kept || kept->built < each->built)) kept = each;
  }
  for (const auto& [address, each] : newest)
    if (each) capsule.structures.push_back({each->name, address, each->bytes, each->inputs});
}

// Sets up what all launches of a pipeline have, lets `set_size(builder)` do the rest, and runs the launch. It
// runs nothing when set_size() returns false. `describe(capsule)` tells a launch that is saved what
// set_size() has set.
template <class SetSize, class Describe>
void launch_with(Queue& queue, const Bindings& bound, LaunchOf launch, SetSize&& set_size,
                 Describe&& describe) {
  Device& device = queue.device;
  const pipeline::LinkedShaders& shaders = bound.pipeline->compiled(device);
  pipeline::LaunchBuilder builder(shaders, device.memory);
  const Allocations allocations(device, builder);
  pipeline::Capsule capsule;
  if (!device.physical.instance.settings.save.is_empty()) builder.note_bindings(capsule.bindings);
  launch.save = [&] {
    begin_capsule(capsule, device, bound, builder.world);
    describe(capsule);
    pipeline::save_memory(capsule, device.memory, builder.allocations());
    return std::move(capsule);
  };
  for (const auto& [place, use] : shaders.declared()) bind(device, builder, bound, use);
  builder.set_push_constants(bound.push_constants);
  exec::PrintLog prints;
  builder.world.prints = &prints;
  builder.world.robust_buffers = device.has("robustBufferAccess") || device.has("robustBufferAccess2");
  builder.world.robust_images = device.has("robustImageAccess") || device.has("robustImageAccess2");
  if (device.has("micromap"))
    builder.world.filter = device.params.rt.leaf_filter.make({nullptr, device.memory});
  builder.world.on_fault = device.physical.instance.settings.on_fault;
  if (!set_size(builder)) return;
  const uint32_t need = device.physical.gpu.rt.unit == rt::kSoftware ? stack_need(device) : 0;
  run_launch(queue, launch, builder.finish(need), prints);
}

}  // namespace

void launch(Queue& queue, const Bindings& bound, const std::array<uint32_t, 3>& base,
            const std::array<uint32_t, 3>& groups) {
  if (!groups[0] || !groups[1] || !groups[2]) return;
  const LaunchOf what{"dispatch", {groups[0], groups[1], groups[2]}, *bound.pipeline};
  const auto set_size = [&](pipeline::LaunchBuilder& builder) {
    builder.set_blocks(0, groups, {bound.pipeline->name, 0, 0});
    const auto& [x, y, z] = builder.world.launch_size;
    queue.device.compute_threads += uint64_t{x} * y * z;
    exec::set_first_block(builder.world, base);
    return true;
  };
  launch_with(queue, bound, what, set_size,
              [&](pipeline::Capsule& capsule) { capsule.size = groups, capsule.base = base; });
}

namespace {

// Cuts off what of a region lies behind the end of its buffer. Its records are outside of the table then.
void cut_to_memory(const mem::AddressSpace& memory, pipeline::DeviceRegion& region) {
  const uint64_t slot = region.base >> mem::AddressSpace::kShift;
  const uint64_t first = region.base - (slot << mem::AddressSpace::kShift);
  const auto slots = memory.slots();
  const uint64_t end = slot < slots.size() ? slots[slot].bytes : 0;
  region.bytes = first < end ? std::min(region.bytes, end - first) : 0;
}

// Returns whether shaders that traces call trace rays themselves.
bool has_nested_traces(const exec::Image& image) {
  for (size_t i = 0; i < image.code.size(); ++i) {
    const isa::Stage stage = image.shaders[image.shader_of[i]].stage;
    if (image.code[i].effect == isa::Effect::Trace &&
        (stage == isa::Stage::ClosestHit || stage == isa::Stage::Miss))
      return true;
  }
  return false;
}

// Returns how deep traces may be nested. Choice: applications declare a depth of 1 and nest traces all the
// same, which drivers of hardware let pass.
uint32_t trace_depth(Device& device, VkPipeline_T& pipeline, const exec::Image& image) {
  RayGroups& rays = *pipeline.rays;
  const bool stops = device.physical.instance.settings.on_fault == exec::OnFault::Stop;
  if (stops || rays.max_trace_depth != 1 || !has_nested_traces(image)) return rays.max_trace_depth;
  if (!std::exchange(rays.has_said_depth, true))
    device.messages().warning(
        fmt::format("{}: maxPipelineRayRecursionDepth is 1, and its closest-hit or miss shaders trace rays; "
                    "they may be nested {} deep here",
                    pipeline.name, kMaxRayRecursion));
  return kMaxRayRecursion;
}

}  // namespace

void launch_rays(Queue& queue, const Bindings& bound, pipeline::DeviceTable table,
                 const std::array<uint32_t, 3>& size) {
  if (!size[0] || !size[1] || !size[2]) return;
  const RayGroups& rays = *bound.pipeline->rays;
  for (pipeline::DeviceRegion* const each : {&table.miss, &table.hit, &table.callable})
    cut_to_memory(queue.device.memory, *each);
  const LaunchOf what{"trace", {size[0], size[1], size[2]}, *bound.pipeline};
  uint32_t depth = 0;
  const auto set_size = [&](pipeline::LaunchBuilder& builder) {
    // Vulkan's default stack has room for two callables, one in the other. More may be called as long as the
    // stack has room.
    depth = trace_depth(queue.device, *bound.pipeline, *builder.world.image);
    builder.set_rays(size, depth, kDefaultCallableDepth, {bound.pipeline->name, 0, 0});
    builder.world.max_callable_depth = kMaxCallableDepth;
    builder.world.added_ray_flags = rays.added_ray_flags;
    // Nothing needs more than the deepest chain of calls.
    if (rays.has_dynamic_stack && bound.stack_bytes)
      builder.world.local_bytes =
          std::min(*bound.stack_bytes, pipeline::stack_bytes(*builder.world.image, depth, kMaxCallableDepth));
    try {
      pipeline::read_binding_table(builder.world, queue.device.memory, table, rays.groups, rays.pipeline);
    } catch (const UserError& error) {
      if (builder.world.on_fault == exec::OnFault::Stop) throw;
      queue.device.messages().error(
          fmt::format("launch of {}: {}\nnothing was traced", bound.pipeline->name, error.what()));
      return false;
    }
    return true;
  };
  launch_with(queue, bound, what, set_size, [&](pipeline::Capsule& capsule) {
    capsule.size = size;
    pipeline::Capsule::Rays& to = capsule.rays.emplace();
    to.groups = rays.groups, to.pipeline = rays.pipeline, to.table = table;
    to.max_trace_depth = depth, to.default_callable_depth = kDefaultCallableDepth;
    to.max_callable_depth = kMaxCallableDepth;
    to.added_flags = rays.added_ray_flags;
    if (rays.has_dynamic_stack) to.stack_bytes = bound.stack_bytes;
  });
}

}  // namespace glint::vulkan
