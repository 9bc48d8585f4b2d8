// Gives a launch the descriptors that its shader uses, as they are when it runs.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/bound_descriptors.h"

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

// Names a binding of a set that is bound.
struct Place {
  const BoundSet& set;
  const LayoutBinding& layout;
  const Descriptor& at(uint32_t element) const { return set.set->descriptors[layout.first + element]; }
};

pipeline::BufferRange buffer_range(Device& device, const Place& place, uint32_t element,
                                   pipeline::BufferRange unbound) {
  const Descriptor& descriptor = place.at(element);
  if (!exists(device, descriptor.buffer)) return unbound;
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

void bind_structures(pipeline::LaunchBuilder& builder, const Place& place, pipeline::BindingPlace number) {
  std::vector<pipeline::BufferRange> all;
  for (uint32_t i = 0; i < place.layout.count; ++i) {
    const Address structure = place.at(i).structure;
    all.push_back(structure ? pipeline::BufferRange{structure, 0} : pipeline::LaunchBuilder::unbound(number));
  }
  builder.bind_buffers(number, all);
}

// Returns the texels of a buffer as an image with one row.
exec::ImageView texels_of(Device& device, const VkBufferView_T& view) {
  const uint64_t bytes = bytes_of(device, view.buffer, view.offset, view.range).bytes;
  exec::ImageView out;
  out.name = view.buffer->name, out.format = view.format, out.shape = isa::ImageShape::Buffer;
  out.width = uint32_t(bytes / out.texel_bytes());
  out.base = address_of_part(device, view.buffer, view.offset, bytes);
  return out;
}

exec::ImageView image_of(Device& device, const Descriptor& descriptor, pipeline::BindingPlace number) {
  if (exists(device, descriptor.texels) && exists(device, descriptor.texels->buffer))
    return texels_of(device, *descriptor.texels);
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
  if (set == bound.sets.end() || !set->second.set) return;
  const uint32_t number_there = bound.pipeline->binding_numbers().original(use.set, use.binding);
  const auto binding = set->second.set->layout.bindings.find(number_there);
  if (binding == set->second.set->layout.bindings.end() || binding->second.count == 0) return;
  const Place place{set->second, binding->second};
  const pipeline::BindingPlace number{use.set, use.binding};
  switch (kind_of(place.layout.type)) {
    case DescriptorKind::Buffer:
      return bind_buffers(device, builder, place, number);
    case DescriptorKind::InlineBlock:
      return builder.bind_buffers(number,
                                  {{set->second.set->inline_blocks.at(number_there), place.layout.count}});
    case DescriptorKind::Sampler:
      return bind_samplers(device, builder, place, number);
    case DescriptorKind::TexelBuffer:
    case DescriptorKind::Image:
      return bind_images(device, builder, place, number);
    case DescriptorKind::AccelerationStructure:
      return bind_structures(builder, place, number);
  }
}

}  // namespace glint::vulkan
