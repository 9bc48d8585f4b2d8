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

const DescriptorSetLayout& layout_at(VkPipelineLayout layout, uint32_t number) {
  if (number >= layout->sets.size()) throw Refusal(fmt::format("the pipeline layout has no set {}", number));
  return layout->sets[number];
}

// Returns the set that is pushed to, as a copy of what was pushed before: earlier launches keep theirs. What
// was pushed with a layout of other bindings is gone.
DescriptorSet& pushed_set(CommandBuffer& commands, VkPipelineBindPoint point, VkPipelineLayout layout,
                          uint32_t number) {
  const DescriptorSetLayout& wanted = layout_at(layout, number);
  BoundSet& bound = bound_at(commands, point)->sets[number];
  bound.stored.reset();
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

void CmdBindDescriptorBuffersEXT(CommandBuffer& commands, uint32_t count,
                                 const VkDescriptorBufferBindingInfoEXT* infos) {
  commands.descriptor_buffers.clear();
  for (uint32_t i = 0; i < count; ++i) commands.descriptor_buffers.push_back(infos[i].address);
}

void CmdSetDescriptorBufferOffsetsEXT(CommandBuffer& commands, VkPipelineBindPoint point,
                                      VkPipelineLayout layout, uint32_t first, uint32_t count,
                                      const uint32_t* buffers, const VkDeviceSize* offsets) {
  Bindings* const bindings = bound_at(commands, point);
  if (!bindings) return;
  for (uint32_t i = 0; i < count; ++i) {
    const DescriptorSetLayout& set = layout_at(layout, first + i);
    if (buffers[i] >= commands.descriptor_buffers.size())
      throw Refusal(fmt::format("set {} lies in descriptor buffer {}, and {} of them are bound", first + i,
                                buffers[i], commands.descriptor_buffers.size()));
    bindings->sets[first + i] = {
        nullptr, nullptr, std::vector<uint32_t>(set.dynamic),
        std::make_shared<StoredSet>(StoredSet{set, commands.descriptor_buffers[buffers[i]] + offsets[i]})};
  }
}

void CmdBindDescriptorBufferEmbeddedSamplersEXT(CommandBuffer& commands, VkPipelineBindPoint point,
                                                VkPipelineLayout layout, uint32_t number) {
  Bindings* const bindings = bound_at(commands, point);
  if (!bindings) return;
  auto samplers = std::make_shared<DescriptorSet>(set_of(layout_at(layout, number)));
  bindings->sets[number] = {samplers.get(), samplers, {}};
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
