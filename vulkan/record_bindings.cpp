// Records what launches find bound: pipelines, descriptor sets and push constants.
// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <fmt/format.h>

#include "vulkan/command_buffer.h"
#include "vulkan/device.h"
#include "vulkan/pipeline.h"

namespace glint::vulkan {
namespace {

// Returns what a bind point has, or null for graphics, which the device does not do.
Bindings* bound_at(CommandBuffer& commands, VkPipelineBindPoint point) {
  switch (point) {
    case VK_PIPELINE_BIND_POINT_COMPUTE:
      return &commands.bound;
    case VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR:
      return &commands.bound_for_rays;
    default:
      return nullptr;
  }
}

// Returns the set that is pushed to, as a copy of what was pushed before: earlier launches keep theirs. What
// was pushed with a layout of other bindings is gone.
DescriptorSet& pushed_set(CommandBuffer& commands, VkPipelineBindPoint point, VkPipelineLayout layout,
                          uint32_t number) {
  if (number >= layout->sets.size()) throw Refusal(fmt::format("the pipeline layout has no set {}", number));
  BoundSet& bound = bound_at(commands, point)->sets[number];
  const DescriptorSetLayout& wanted = layout->sets[number];
  const bool goes_on = bound.pushed && bound.pushed->layout.bindings == wanted.bindings;
  bound.pushed = std::make_shared<DescriptorSet>(goes_on ? *bound.pushed : set_of(wanted));
  bound.set = bound.pushed.get();
  return *bound.set;
}

}  // namespace

void CmdBindPipeline(CommandBuffer& commands, VkPipelineBindPoint point, VkPipeline pipeline) {
  if (Bindings* const bound = bound_at(commands, point))
    bound->pipeline = pipeline;
  else
    commands.graphics_pipeline = pipeline->name;
}

void CmdBindDescriptorSets(CommandBuffer& commands, VkPipelineBindPoint point, VkPipelineLayout,
                           uint32_t first, uint32_t count, const VkDescriptorSet* sets, uint32_t num_offsets,
                           const uint32_t* offsets) {
  Bindings* const bindings = bound_at(commands, point);
  if (!bindings) return;
  const uint32_t* const end = offsets + num_offsets;
  for (uint32_t i = 0; i < count; ++i) {
    BoundSet& bound = bindings->sets[first + i] = {sets[i], nullptr, {}};
    if (!sets[i]) continue;
    const uint32_t dynamic = sets[i]->layout.dynamic;
    if (dynamic > uint32_t(end - offsets))
      throw Refusal(
          fmt::format("set {} has {} dynamic descriptors, and offsets are missing", first + i, dynamic));
    bound.dynamic_offsets.assign(offsets, offsets + dynamic);
    offsets += dynamic;
  }
}

void CmdPushConstants(CommandBuffer& commands, VkPipelineLayout, VkShaderStageFlags, uint32_t offset,
                      uint32_t bytes, const void* from) {
  if (offset > kMaxPushConstantBytes || bytes > kMaxPushConstantBytes - offset)
    throw Refusal(fmt::format("{} bytes of push constants at byte {} do not fit into {}", bytes, offset,
                              kMaxPushConstantBytes));
  for (Bindings* const bound : {&commands.bound, &commands.bound_for_rays})
    std::memcpy(bound->push_constants.data() + offset, from, bytes);
}

void CmdPushDescriptorSetKHR(CommandBuffer& commands, VkPipelineBindPoint point, VkPipelineLayout layout,
                             uint32_t number, uint32_t count, const VkWriteDescriptorSet* writes) {
  if (!bound_at(commands, point)) return;
  DescriptorSet& set = pushed_set(commands, point, layout, number);
  for (uint32_t i = 0; i < count; ++i) write(commands.device, set, writes[i]);
}

void CmdPushDescriptorSetWithTemplateKHR(CommandBuffer& commands, VkDescriptorUpdateTemplate with,
                                         VkPipelineLayout layout, uint32_t number, const void* data) {
  if (!bound_at(commands, with->point)) return;
  write(commands.device, pushed_set(commands, with->point, layout, number), *with, data);
}

}  // namespace glint::vulkan
