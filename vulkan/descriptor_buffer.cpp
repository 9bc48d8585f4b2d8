// Reads descriptors that an application keeps in buffers of its own (VK_EXT_descriptor_buffer).
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/descriptor_buffer.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <fmt/format.h>

#include "vulkan/device.h"

namespace glint::vulkan {
namespace {

// Is a descriptor as it lies in memory. The type plus one comes with it, so zeros are none.
struct Stored {
  uint64_t first = 0;   // a view, a sampler that is alone, a structure, or the address of bytes
  uint64_t second = 0;  // the sampler of an image, or the number of bytes
  uint32_t type_plus_one = 0;
  VkFormat format = VK_FORMAT_UNDEFINED;  // of texels in a buffer
  uint64_t unused = 0;
};
static_assert(sizeof(Stored) == kStoredBytes);

template <class Handle>
uint64_t number_of(Handle handle) {
  return reinterpret_cast<uintptr_t>(handle);
}
template <class Handle>
Handle handle_of(uint64_t number) {
  return reinterpret_cast<Handle>(uintptr_t(number));
}

Stored stored_from(const VkDescriptorGetInfoEXT& info) {
  Stored out;
  out.type_plus_one = uint32_t(info.type) + 1;
  switch (kind_of(info.type)) {
    case DescriptorKind::PlainBuffer:
    case DescriptorKind::TexelBuffer:
      // All kinds of buffers have the same pointer in the union.
      if (const VkDescriptorAddressInfoEXT* const bytes = info.data.pStorageBuffer)
        out.first = bytes->address, out.second = bytes->range, out.format = bytes->format;
      break;
    case DescriptorKind::Image:
      if (const VkDescriptorImageInfo* const image = info.data.pCombinedImageSampler) {
        out.first = number_of(image->imageView);
        if (has_sampler(info.type)) out.second = number_of(image->sampler);
      }
      break;
    case DescriptorKind::Sampler:
      out.first = number_of(*info.data.pSampler);
      break;
    case DescriptorKind::AccelerationStructure:
      out.first = info.data.accelerationStructure;
      break;
    case DescriptorKind::InlineBlock:
      throw Refusal("an inline uniform block has no descriptor: its bytes lie in the buffer themselves");
  }
  return out;
}

void unpack(const Stored& from, DescriptorKind kind, Descriptor& to) {
  if (from.type_plus_one == 0 || kind_of(VkDescriptorType(from.type_plus_one - 1)) != kind) return;
  to.is_null = from.first == 0;
  switch (kind) {
    case DescriptorKind::PlainBuffer:
    case DescriptorKind::TexelBuffer:
      to.address = from.first, to.range = from.second, to.format = from.format;
      break;
    case DescriptorKind::Image:
      to.view = handle_of<VkImageView>(from.first);
      if (!to.sampler) to.sampler = handle_of<VkSampler>(from.second);
      break;
    case DescriptorKind::Sampler:
      if (!to.sampler) to.sampler = handle_of<VkSampler>(from.first);
      break;
    case DescriptorKind::AccelerationStructure:
      to.structure = from.first;
      break;
    case DescriptorKind::InlineBlock:
      break;
  }
}

VkDeviceSize bytes_of_binding(const LayoutBinding& binding) {
  constexpr VkDeviceSize kStep = kStoredBytes;
  return binding.is_inline() ? (binding.count + kStep - 1) / kStep * kStep : binding.count * kStep;
}

// No descriptor can be captured and replayed, so there is nothing to tell.
VkResult no_capture(void* out) {
  std::memset(out, 0, sizeof(uint64_t));
  return VK_SUCCESS;
}

}  // namespace

VkDeviceSize stored_offset(const DescriptorSetLayout& layout, uint32_t number) {
  VkDeviceSize offset = 0;
  for (const auto& [at, binding] : layout.bindings) {
    if (at == number) return offset;
    offset += bytes_of_binding(binding);
  }
  throw Refusal(fmt::format("the layout of a descriptor set has no binding {}", number));
}

std::vector<Descriptor> read_stored(const Device& device, const StoredSet& set, uint32_t number) {
  const LayoutBinding& binding = set.layout.bindings.at(number);
  std::vector<Descriptor> out(binding.is_inline() ? 0 : binding.count);
  Address at = set.address + stored_offset(set.layout, number);
  for (uint32_t i = 0; i < out.size(); ++i, at += kStoredBytes) {
    if (i < binding.immutable.size()) out[i].sampler = binding.immutable[i];
    const std::byte* const bytes = device.memory.find(at, kStoredBytes);
    if (!bytes) continue;
    Stored stored;
    std::memcpy(&stored, bytes, sizeof stored);
    unpack(stored, kind_of(binding.type), out[i]);
  }
  return out;
}

void GetDescriptorSetLayoutSizeEXT(Device&, VkDescriptorSetLayout layout, VkDeviceSize* out) {
  *out = 0;
  for (const auto& [number, binding] : layout->bindings) *out += bytes_of_binding(binding);
}
void GetDescriptorSetLayoutBindingOffsetEXT(Device&, VkDescriptorSetLayout layout, uint32_t binding,
                                            VkDeviceSize* out) {
  *out = stored_offset(*layout, binding);
}

void GetDescriptorEXT(Device&, const VkDescriptorGetInfoEXT* info, size_t bytes, void* out) {
  const Stored stored = stored_from(*info);
  std::memcpy(out, &stored, std::min(bytes, sizeof stored));
}

VkResult GetBufferOpaqueCaptureDescriptorDataEXT(Device&, const VkBufferCaptureDescriptorDataInfoEXT*,
                                                 void* out) {
  return no_capture(out);
}
VkResult GetImageOpaqueCaptureDescriptorDataEXT(Device&, const VkImageCaptureDescriptorDataInfoEXT*,
                                                void* out) {
  return no_capture(out);
}
VkResult GetImageViewOpaqueCaptureDescriptorDataEXT(Device&, const VkImageViewCaptureDescriptorDataInfoEXT*,
                                                    void* out) {
  return no_capture(out);
}
VkResult GetSamplerOpaqueCaptureDescriptorDataEXT(Device&, const VkSamplerCaptureDescriptorDataInfoEXT*,
                                                  void* out) {
  return no_capture(out);
}
VkResult GetAccelerationStructureOpaqueCaptureDescriptorDataEXT(
    Device&, const VkAccelerationStructureCaptureDescriptorDataInfoEXT*, void* out) {
  return no_capture(out);
}

}  // namespace glint::vulkan
