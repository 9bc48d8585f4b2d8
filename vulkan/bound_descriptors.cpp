// Gives a launch the descriptors that its shader uses, as they are when it runs.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/bound_descriptors.h"

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "vulkan/device.h"
#include "vulkan/image.h"
#include "vulkan/memory.h"
#include "vulkan/pipeline.h"

namespace glint::vulkan {
namespace {

// Returns whether what a descriptor names is there. What is destroyed may stand in a set until a shader uses
// it, which is a fault then.
bool exists(const Device& device, const void* resource) {
  return resource && device.bindable.contains(resource);
}

// Returns whether the buffer of a descriptor has memory, which the application may have freed.
bool has_memory(const Device& device, VkBuffer buffer) {
  return exists(device, buffer) && device.memory.find(buffer->address, buffer->bytes);
}

// Returns whether a descriptor stands for nothing on purpose.
bool is_null(const Device& device, const Descriptor& descriptor) {
  return descriptor.is_null && device.has("nullDescriptor");
}

// Names a binding of a set that is bound, with its descriptors.
struct Place {
  const BoundSet& set;
  const LayoutBinding& layout;
  std::span<const Descriptor> descriptors;
  const Descriptor& at(uint32_t element) const { return descriptors[element]; }
};

// Returns the layout of a set that is bound, or null.
const DescriptorSetLayout* bound_layout(const BoundSet& bound) {
  if (bound.stored) return &bound.stored->layout;
  return bound.set ? &bound.set->layout : nullptr;
}

// Returns the descriptors of a binding. An inline uniform block has none.
std::span<const Descriptor> descriptors_of(const DescriptorSet& set, const LayoutBinding& binding) {
  return std::span(set.descriptors).subspan(binding.first, binding.is_inline() ? 0 : binding.count);
}

// Returns where the bytes of an inline uniform block lie.
Address inline_block_of(const BoundSet& bound, uint32_t number) {
  if (bound.stored) return bound.stored->address + stored_offset(bound.stored->layout, number);
  return bound.set->inline_blocks.at(number);
}

pipeline::BufferRange buffer_range(Device& device, const Place& place, uint32_t element,
                                   pipeline::BufferRange unbound) {
  const Descriptor& descriptor = place.at(element);
  if (descriptor.address)
    return {device.parts.open(device.memory, descriptor.address, descriptor.range), descriptor.range};
  if (is_null(device, descriptor)) return pipeline::LaunchBuilder::null();
  if (!has_memory(device, descriptor.buffer)) return unbound;
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
    all.push_back(buffer_range(device, place, i, pipeline::LaunchBuilder::unbound(number)));
  builder.bind_buffers(number, all);
}

// A ray into a structure at address 0 misses.
void bind_structures(const Device& device, pipeline::LaunchBuilder& builder, const Place& place,
                     pipeline::BindingPlace number) {
  std::vector<pipeline::BufferRange> all;
  for (uint32_t i = 0; i < place.layout.count; ++i) {
    const Address structure = place.at(i).structure;
    all.push_back(structure || is_null(device, place.at(i)) ? pipeline::BufferRange{structure, 0}
                                                            : pipeline::LaunchBuilder::unbound(number));
  }
  builder.bind_buffers(number, all);
}

// Returns texels as an image with one row.
exec::ImageView row_of_texels(std::string name, exec::TexelFormat format, Address address, uint64_t bytes) {
  exec::ImageView out;
  out.name = std::move(name), out.format = format, out.shape = isa::ImageShape::Buffer;
  out.width = uint32_t(bytes / out.texel_bytes());
  out.base = address;
  return out;
}

exec::ImageView texels_of(Device& device, const VkBufferView_T& view) {
  const uint64_t bytes = bytes_of(device, view.buffer, view.offset, view.range).bytes;
  const Address address = address_of_part(device, view.buffer, view.offset, bytes);
  return row_of_texels(view.buffer->name, view.format, address, bytes);
}

exec::ImageView image_of(Device& device, const Descriptor& descriptor, pipeline::BindingPlace number) {
  if (descriptor.address)
    return row_of_texels("texels at an address", texel_format_of(descriptor.format), descriptor.address,
                         descriptor.range);
  if (exists(device, descriptor.texels) && has_memory(device, descriptor.texels->buffer))
    return texels_of(device, *descriptor.texels);
  if (is_null(device, descriptor)) return pipeline::null_image();
  if (!exists(device, descriptor.view)) return pipeline::unbound_image(number);
  exec::ImageView out = descriptor.view->view;
  if (exists(device, descriptor.sampler)) out.sampler = descriptor.sampler->sampler;
  return out;
}

void bind_images(Device& device, pipeline::LaunchBuilder& builder, const Place& place,
                 pipeline::BindingPlace number) {
  std::vector<exec::ImageView> all;
  for (uint32_t i = 0; i < place.layout.count; ++i) all.push_back(image_of(device, place.at(i), number));
  builder.bind_images(number, std::move(all));
}

void bind_samplers(const Device& device, pipeline::LaunchBuilder& builder, const Place& place,
                   pipeline::BindingPlace number) {
  std::vector<exec::Sampler> all;
  for (uint32_t i = 0; i < place.layout.count; ++i) {
    const VkSampler sampler = place.at(i).sampler;
    all.push_back(exists(device, sampler) ? sampler->sampler : pipeline::unbound_sampler(number));
  }
  builder.bind_samplers(number, std::move(all));
}

}  // namespace

void bind(Device& device, pipeline::LaunchBuilder& builder, const Bindings& bound,
          const frontend::Binding& use) {
  const auto set = bound.sets.find(use.set);
  const DescriptorSetLayout* const layout = set == bound.sets.end() ? nullptr : bound_layout(set->second);
  if (!layout) return;
  const uint32_t number_there = bound.pipeline->binding_numbers().original(use.set, use.binding);
  const auto binding = layout->bindings.find(number_there);
  if (binding == layout->bindings.end() || binding->second.count == 0) return;
  std::vector<Descriptor> stored;
  if (set->second.stored) stored = read_stored(device, *set->second.stored, number_there);
  const Place place{set->second, binding->second,
                    set->second.stored ? stored : descriptors_of(*set->second.set, binding->second)};
  const pipeline::BindingPlace number{use.set, use.binding};
  switch (kind_of(place.layout.type)) {
    case DescriptorKind::PlainBuffer:
      return bind_buffers(device, builder, place, number);
    case DescriptorKind::InlineBlock:
      return builder.bind_buffers(number, {{inline_block_of(set->second, number_there), place.layout.count}});
    case DescriptorKind::Sampler:
      return bind_samplers(device, builder, place, number);
    case DescriptorKind::TexelBuffer:
    case DescriptorKind::Image:
      return bind_images(device, builder, place, number);
    case DescriptorKind::AccelerationStructure:
      return bind_structures(device, builder, place, number);
  }
}

}  // namespace glint::vulkan
