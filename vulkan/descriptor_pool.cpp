// Makes layouts and pools of descriptor sets, and allocates sets.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <memory>

#include "vulkan/chain.h"
#include "vulkan/descriptor_set.h"
#include "vulkan/device.h"

namespace glint::vulkan {
namespace {

void add_binding(DescriptorSetLayout& layout, const VkDescriptorSetLayoutBinding& from, bool is_variable) {
  LayoutBinding& to = layout.bindings[from.binding];
  to.type = from.descriptorType, to.count = from.descriptorCount, to.is_variable = is_variable;
  if (has_sampler(to.type) && from.pImmutableSamplers)
    to.immutable.assign(from.pImmutableSamplers, from.pImmutableSamplers + from.descriptorCount);
}

// Gives the bindings, in their order, their places among the descriptors and the dynamic offsets of a set.
void number_descriptors(DescriptorSetLayout& layout) {
  for (auto& [number, binding] : layout.bindings) {
    binding.first = layout.descriptors, binding.first_dynamic = layout.dynamic;
    if (!binding.is_inline()) layout.descriptors += binding.count;
    if (binding.is_dynamic()) layout.dynamic += binding.count;
  }
}

DescriptorSetLayout layout_of(const VkDescriptorSetLayoutCreateInfo& info) {
  const auto* flags = find_in_chain<VkDescriptorSetLayoutBindingFlagsCreateInfo>(
      &info, VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO);
  DescriptorSetLayout layout;
  for (uint32_t i = 0; i < info.bindingCount; ++i)
    add_binding(layout, info.pBindings[i],
                flags && i < flags->bindingCount &&
                    (flags->pBindingFlags[i] & VK_DESCRIPTOR_BINDING_VARIABLE_DESCRIPTOR_COUNT_BIT));
  number_descriptors(layout);
  return layout;
}

void free_set(Device& device, DescriptorSet* set) {
  for (const auto& [binding, address] : set->inline_blocks) device.memory.free(address);
  delete set;
}

void free_all(Device& device, VkDescriptorPool pool) {
  for (DescriptorSet* set : pool->sets) free_set(device, set);
  pool->sets.clear();
}

DescriptorSet* allocate(Device& device, VkDescriptorPool pool, const DescriptorSetLayout& layout,
                        const uint32_t* variable_count) {
  DescriptorSetLayout own = layout;
  for (auto& [number, binding] : own.bindings)
    if (binding.is_variable) {  // It is the last binding, so no other one moves.
      const uint32_t count = variable_count ? *variable_count : 0;
      if (!binding.is_inline()) own.descriptors -= binding.count, own.descriptors += count;
      binding.count = count;
    }
  auto made = std::make_unique<DescriptorSet>(set_of(own));
  made->pool = pool;
  for (const auto& [number, binding] : own.bindings)
    if (binding.is_inline())
      made->inline_blocks[number] =
          device.memory.allocate(fmt::format("inline uniform block {}", number), binding.count);
  pool->sets.insert(made.get());
  return made.release();
}

}  // namespace

DescriptorSet set_of(const DescriptorSetLayout& layout) {
  DescriptorSet set{layout, {}, {}, nullptr};
  set.descriptors.resize(layout.descriptors);
  for (const auto& [number, binding] : layout.bindings)
    for (size_t i = 0; i < binding.immutable.size() && i < binding.count; ++i)
      set.descriptors[binding.first + i].sampler = binding.immutable[i];
  return set;
}

VkResult CreateDescriptorSetLayout(Device&, const VkDescriptorSetLayoutCreateInfo* info,
                                   VkDescriptorSetLayout* out) {
  *out = new DescriptorSetLayout(layout_of(*info));
  return VK_SUCCESS;
}
void DestroyDescriptorSetLayout(Device&, VkDescriptorSetLayout layout) {
  delete layout;
}

void GetDescriptorSetLayoutSupport(Device&, const VkDescriptorSetLayoutCreateInfo* info,
                                   VkDescriptorSetLayoutSupport* out) {
  const DescriptorSetLayout layout = layout_of(*info);
  uint64_t descriptors = 0;
  for (const auto& [number, binding] : layout.bindings)
    descriptors += binding.is_inline() ? 1 : binding.count;
  out->supported = descriptors <= kManyDescriptors;
  if (auto* variable = find_in_output<VkDescriptorSetVariableDescriptorCountLayoutSupport>(
          out, VK_STRUCTURE_TYPE_DESCRIPTOR_SET_VARIABLE_DESCRIPTOR_COUNT_LAYOUT_SUPPORT)) {
    variable->maxVariableDescriptorCount = 0;
    for (const auto& [number, binding] : layout.bindings)
      if (binding.is_variable) variable->maxVariableDescriptorCount = binding.count;
  }
}

VkResult CreateDescriptorPool(Device&, const VkDescriptorPoolCreateInfo* info, VkDescriptorPool* out) {
  *out = new VkDescriptorPool_T{{}, info->maxSets};
  return VK_SUCCESS;
}
void DestroyDescriptorPool(Device& device, VkDescriptorPool pool) {
  if (!pool) return;
  free_all(device, pool);
  delete pool;
}
VkResult ResetDescriptorPool(Device& device, VkDescriptorPool pool, VkDescriptorPoolResetFlags) {
  free_all(device, pool);
  return VK_SUCCESS;
}

// Choice: a pool counts sets only. The numbers of descriptors of each type are the host's memory.
VkResult AllocateDescriptorSets(Device& device, const VkDescriptorSetAllocateInfo* info,
                                VkDescriptorSet* out) {
  const auto* variable = find_in_chain<VkDescriptorSetVariableDescriptorCountAllocateInfo>(
      info, VK_STRUCTURE_TYPE_DESCRIPTOR_SET_VARIABLE_DESCRIPTOR_COUNT_ALLOCATE_INFO);
  std::fill_n(out, info->descriptorSetCount, VkDescriptorSet{});
  if (info->descriptorPool->sets.size() + info->descriptorSetCount > info->descriptorPool->max_sets)
    return VK_ERROR_OUT_OF_POOL_MEMORY;
  for (uint32_t i = 0; i < info->descriptorSetCount; ++i)
    out[i] =
        allocate(device, info->descriptorPool, *info->pSetLayouts[i],
                 variable && i < variable->descriptorSetCount ? &variable->pDescriptorCounts[i] : nullptr);
  return VK_SUCCESS;
}
VkResult FreeDescriptorSets(Device& device, VkDescriptorPool pool, uint32_t count,
                            const VkDescriptorSet* sets) {
  for (uint32_t i = 0; i < count; ++i) {
    if (!sets[i]) continue;
    pool->sets.erase(sets[i]);
    free_set(device, sets[i]);
  }
  return VK_SUCCESS;
}

}  // namespace glint::vulkan
