// Gives a launch the descriptors that its shader uses, as they are when it runs.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/bound_descriptors.h"

#include <vector>

#include "vulkan/device.h"
#include "vulkan/memory.h"

namespace glint::vulkan {
namespace {

// Names a binding of a set that is bound.
struct Place {
  const BoundSet& set;
  const LayoutBinding& layout;
  const Descriptor& at(uint32_t element) const { return set.set->descriptors[layout.first + element]; }
};

pipeline::BufferRange range_of(Device& device, const Place& place, uint32_t element,
                               pipeline::BufferRange unbound) {
  const Descriptor& descriptor = place.at(element);
  if (!descriptor.buffer) return unbound;
  const VkDeviceSize dynamic =
      place.layout.is_dynamic() ? place.set.dynamic_offsets.at(place.layout.first_dynamic + element) : 0;
  const VkDeviceSize offset = descriptor.offset + dynamic;
  const uint64_t bytes = bytes_of(device, descriptor.buffer, offset, descriptor.range).bytes;
  return {address_of_part(device, descriptor.buffer, offset, bytes), bytes};
}

void bind_buffers(Device& device, pipeline::LaunchBuilder& builder, const Place& place,
                  pipeline::BindingPlace number) {
  std::vector<pipeline::BufferRange> all;
  for (uint32_t i = 0; i < place.layout.count; ++i)
    all.push_back(range_of(device, place, i, pipeline::LaunchBuilder::unbound(number)));
  builder.bind_buffers(number, all);
}

}  // namespace

void bind(Device& device, pipeline::LaunchBuilder& builder, const Bindings& bound,
          const frontend::Binding& use) {
  const auto set = bound.sets.find(use.set);
  if (set == bound.sets.end() || !set->second.set) return;
  const auto binding = set->second.set->layout.bindings.find(use.binding);
  if (binding == set->second.set->layout.bindings.end() || binding->second.count == 0) return;
  const Place place{set->second, binding->second};
  const pipeline::BindingPlace number{use.set, use.binding};
  switch (place.layout.type) {
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC:
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC:
      return bind_buffers(device, builder, place, number);
    case VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK:
      return builder.bind_buffers(number,
                                  {{set->second.set->inline_blocks.at(use.binding), place.layout.count}});
    default:
      return;
  }
}

}  // namespace glint::vulkan
