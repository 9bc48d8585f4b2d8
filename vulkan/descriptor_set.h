// Holds layouts of descriptor sets, pools, and sets.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "base/types.h"
#include "vulkan/handles.h"

namespace glint::vulkan {

// Is one descriptor as the application wrote it. Which members mean something depends on the binding's type.
struct Descriptor {
  VkBuffer buffer = nullptr;
  VkDeviceSize offset = 0, range = 0;
  VkImageView view = nullptr;
  VkSampler sampler = nullptr;
  VkBufferView texels = nullptr;
  Address structure = 0;  // of an acceleration structure
  // Names bytes instead of `buffer` or `texels` where descriptors lie in memory.
  Address address = 0;
  VkFormat format = VK_FORMAT_UNDEFINED;  // of texels at `address`
  // The application wrote VK_NULL_HANDLE. With the feature nullDescriptor this is a descriptor of nothing,
  // and otherwise the same as one that was never written.
  bool is_null = false;
};

// Says what descriptors of a type refer to.
enum class DescriptorKind : uint8_t {
  PlainBuffer,
  InlineBlock,
  TexelBuffer,
  Image,
  Sampler,
  AccelerationStructure
};
DescriptorKind kind_of(VkDescriptorType type);
// Returns whether a descriptor of the type has a sampler, alone or with its image.
bool has_sampler(VkDescriptorType type);

struct LayoutBinding {
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_SAMPLER;
  uint32_t count = 0;          // descriptors; of an inline uniform block: bytes
  uint32_t first = 0;          // of the set's descriptors
  uint32_t first_dynamic = 0;  // of the set's dynamic offsets
  bool is_variable = false;    // An allocation may have fewer.
  std::vector<VkSampler> immutable;

  bool is_dynamic() const {
    return type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC ||
           type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC;
  }
  bool operator==(const LayoutBinding&) const = default;
  bool is_inline() const { return kind_of(type) == DescriptorKind::InlineBlock; }
};

}  // namespace glint::vulkan

struct VkDescriptorSetLayout_T {
  std::map<uint32_t, glint::vulkan::LayoutBinding> bindings;  // by number
  uint32_t descriptors = 0, dynamic = 0;                      // of a set
};

struct VkDescriptorSet_T {
  // A set keeps a copy of its layout, because the application may destroy the layout first.
  VkDescriptorSetLayout_T layout;
  std::vector<glint::vulkan::Descriptor> descriptors;
  std::map<uint32_t, glint::Address> inline_blocks;  // by binding
  VkDescriptorPool pool = nullptr;                   // null: pushed
};

struct VkDescriptorPool_T {
  std::set<VkDescriptorSet> sets;
  uint32_t max_sets = 0;
};

struct VkDescriptorUpdateTemplate_T {
  std::vector<VkDescriptorUpdateTemplateEntry> entries;
  uint32_t set = 0;                                            // of a template that pushes
  VkPipelineBindPoint point = VK_PIPELINE_BIND_POINT_COMPUTE;  // of a template that pushes
};

namespace glint::vulkan {

using DescriptorSetLayout = VkDescriptorSetLayout_T;
using DescriptorSet = VkDescriptorSet_T;

// Returns a set whose descriptors are not written yet, except for immutable samplers.
DescriptorSet set_of(const DescriptorSetLayout& layout);

// Writes what a VkWriteDescriptorSet says. `device` holds the bytes of inline blocks.
void write(Device& device, DescriptorSet& set, const VkWriteDescriptorSet& from);
// Writes what a template finds at `data`.
void write(Device& device, DescriptorSet& set, const VkDescriptorUpdateTemplate_T& with, const void* data);

}  // namespace glint::vulkan
