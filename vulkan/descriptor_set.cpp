// Writes and copies descriptors.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/descriptor_set.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

#include "vulkan/acceleration_structure.h"
#include "vulkan/chain.h"
#include "vulkan/device.h"

namespace glint::vulkan {
namespace {

// Walks the descriptors of a set from one element of a binding on, and from a binding's end into the next
// binding.
class Cursor {
 public:
  Cursor(DescriptorSet& set, uint32_t binding, uint32_t element)
      : set_(set), at_(set.layout.bindings.find(binding)), element_(element) {
    if (at_ == set.layout.bindings.end())
      throw Refusal(fmt::format("the layout of a descriptor set has no binding {}", binding));
    skip_full();
  }
  const LayoutBinding& binding() const { return at_->second; }
  Descriptor& next() {
    skip_full();
    return set_.descriptors.at(binding().first + element_++);
  }
  // Returns whether the sampler of the descriptor that next() returned last is the layout's.
  bool has_immutable_sampler() const { return !binding().immutable.empty(); }

 private:
  void skip_full() {
    while (at_ != set_.layout.bindings.end() && element_ >= binding().count) {
      element_ -= binding().count;
      ++at_;
    }
    if (at_ == set_.layout.bindings.end())
      throw Refusal("more descriptors are written than the layout of the set has");
  }

  DescriptorSet& set_;
  std::map<uint32_t, LayoutBinding>::iterator at_;
  uint32_t element_;
};

void write_one(Cursor& cursor, VkDescriptorType type, const void* info) {
  Descriptor& to = cursor.next();
  const DescriptorKind kind = kind_of(type);
  if (kind == DescriptorKind::PlainBuffer) {
    const auto& from = *static_cast<const VkDescriptorBufferInfo*>(info);
    to.buffer = from.buffer, to.offset = from.offset, to.range = from.range;
    to.is_null = !from.buffer;
    return;
  }
  if (kind == DescriptorKind::TexelBuffer) {
    to.texels = *static_cast<const VkBufferView*>(info);
    to.is_null = !to.texels;
    return;
  }
  if (kind == DescriptorKind::AccelerationStructure) {
    const auto from = *static_cast<const VkAccelerationStructureKHR*>(info);
    to.structure = from ? from->address : 0;
    to.is_null = !from;
    return;
  }
  const auto& from = *static_cast<const VkDescriptorImageInfo*>(info);
  if (kind == DescriptorKind::Image) to.view = from.imageView, to.is_null = !from.imageView;
  if (has_sampler(type) && !cursor.has_immutable_sampler()) to.sampler = from.sampler;
}

// Returns where the application keeps what it writes to a descriptor.
const void* info_of(const VkWriteDescriptorSet& from, uint32_t element) {
  switch (kind_of(from.descriptorType)) {
    case DescriptorKind::PlainBuffer:
      return from.pBufferInfo + element;
    case DescriptorKind::TexelBuffer:
      return from.pTexelBufferView + element;
    case DescriptorKind::AccelerationStructure: {
      const auto* const more = find_in_chain<VkWriteDescriptorSetAccelerationStructureKHR>(
          &from, VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR);
      if (!more || element >= more->accelerationStructureCount)
        throw Refusal("a descriptor of an acceleration structure is written without one");
      return more->pAccelerationStructures + element;
    }
    case DescriptorKind::InlineBlock:
    case DescriptorKind::Image:
    case DescriptorKind::Sampler:
      break;
  }
  return from.pImageInfo + element;
}

// Writes bytes of an inline uniform block.
void write_inline(Device& device, DescriptorSet& set, uint32_t binding, uint32_t first, uint32_t bytes,
                  const void* from) {
  const auto block = set.inline_blocks.find(binding);
  if (block == set.inline_blocks.end() || first + bytes > set.layout.bindings.at(binding).count)
    throw Refusal(fmt::format("binding {} has no {} inline bytes at byte {}", binding, bytes, first));
  device.memory.write(block->second + first, from, bytes);
}

void copy(Device& device, const VkCopyDescriptorSet& info) {
  if (info.srcSet->inline_blocks.count(info.srcBinding)) {
    const Address from = info.srcSet->inline_blocks.at(info.srcBinding) + info.srcArrayElement;
    if (const std::byte* const bytes = device.memory.find(from, info.descriptorCount))
      write_inline(device, *info.dstSet, info.dstBinding, info.dstArrayElement, info.descriptorCount, bytes);
    return;
  }
  Cursor from(*info.srcSet, info.srcBinding, info.srcArrayElement);
  Cursor to(*info.dstSet, info.dstBinding, info.dstArrayElement);
  for (uint32_t i = 0; i < info.descriptorCount; ++i) {
    Descriptor taken = from.next();
    Descriptor& written = to.next();
    if (to.has_immutable_sampler()) taken.sampler = written.sampler;
    written = taken;
  }
}

}  // namespace

DescriptorKind kind_of(VkDescriptorType type) {
  switch (type) {
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC:
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC:
      return DescriptorKind::PlainBuffer;
    case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
    case VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER:
      return DescriptorKind::TexelBuffer;
    case VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK:
      return DescriptorKind::InlineBlock;
    case VK_DESCRIPTOR_TYPE_SAMPLER:
      return DescriptorKind::Sampler;
    case VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR:
      return DescriptorKind::AccelerationStructure;
    default:
      return DescriptorKind::Image;
  }
}

bool has_sampler(VkDescriptorType type) {
  return type == VK_DESCRIPTOR_TYPE_SAMPLER || type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
}

void write(Device& device, DescriptorSet& set, const VkWriteDescriptorSet& from) {
  if (kind_of(from.descriptorType) == DescriptorKind::InlineBlock) {
    const auto* block = find_in_chain<VkWriteDescriptorSetInlineUniformBlock>(
        &from, VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_INLINE_UNIFORM_BLOCK);
    if (block)
      write_inline(device, set, from.dstBinding, from.dstArrayElement, block->dataSize, block->pData);
    return;
  }
  Cursor cursor(set, from.dstBinding, from.dstArrayElement);
  for (uint32_t i = 0; i < from.descriptorCount; ++i)
    write_one(cursor, from.descriptorType, info_of(from, i));
}

void write(Device& device, DescriptorSet& set, const VkDescriptorUpdateTemplate_T& with, const void* data) {
  for (const VkDescriptorUpdateTemplateEntry& entry : with.entries) {
    const auto* from = static_cast<const std::byte*>(data) + entry.offset;
    if (kind_of(entry.descriptorType) == DescriptorKind::InlineBlock) {
      write_inline(device, set, entry.dstBinding, entry.dstArrayElement, entry.descriptorCount, from);
      continue;
    }
    Cursor cursor(set, entry.dstBinding, entry.dstArrayElement);
    for (uint32_t i = 0; i < entry.descriptorCount; ++i)
      write_one(cursor, entry.descriptorType, from + i * entry.stride);
  }
}

void UpdateDescriptorSets(Device& device, uint32_t writes, const VkWriteDescriptorSet* write_infos,
                          uint32_t copies, const VkCopyDescriptorSet* copy_infos) {
  for (uint32_t i = 0; i < writes; ++i) write(device, *write_infos[i].dstSet, write_infos[i]);
  for (uint32_t i = 0; i < copies; ++i) copy(device, copy_infos[i]);
}

VkResult CreateDescriptorUpdateTemplate(Device&, const VkDescriptorUpdateTemplateCreateInfo* info,
                                        VkDescriptorUpdateTemplate* out) {
  *out = new VkDescriptorUpdateTemplate_T{
      {info->pDescriptorUpdateEntries, info->pDescriptorUpdateEntries + info->descriptorUpdateEntryCount},
      info->set,
      info->pipelineBindPoint};
  return VK_SUCCESS;
}
void DestroyDescriptorUpdateTemplate(Device&, VkDescriptorUpdateTemplate with) {
  delete with;
}
void UpdateDescriptorSetWithTemplate(Device& device, VkDescriptorSet set, VkDescriptorUpdateTemplate with,
                                     const void* data) {
  write(device, *set, *with, data);
}

}  // namespace glint::vulkan
