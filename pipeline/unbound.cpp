// Fills the descriptors that nobody bound.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/unbound.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <string>
#include <utility>
#include <vector>

#include "isa/descriptors.h"

namespace glint::pipeline {
namespace {

using frontend::BindingKind;

// This many elements of an array get a place of their own, so that no index into them means another image.
constexpr uint32_t kMostPlaceholders = 1024;

std::string title(const frontend::Binding& binding) {
  return fmt::format("set {} binding {}{}", binding.set, binding.binding,
                     binding.name.empty() ? "" : fmt::format(" ({})", binding.name));
}

exec::ImageView image_titled(std::string title) {
  exec::ImageView out;
  out.name = std::move(title), out.is_bound = false;
  return out;
}

exec::Sampler sampler_titled(std::string title) {
  exec::Sampler out;
  out.unbound = std::move(title);
  return out;
}

frontend::Binding nameless(BindingPlace place) {
  frontend::Binding out;
  out.set = place.first, out.binding = place.second;
  return out;
}

}  // namespace

exec::ImageView unbound_image(BindingPlace place) {
  return image_titled(title(nameless(place)));
}

exec::ImageView null_image() {
  exec::ImageView out = image_titled("null descriptor");
  out.is_null = true;
  return out;
}

exec::Sampler unbound_sampler(BindingPlace place) {
  return sampler_titled(title(nameless(place)));
}

void write_descriptor(exec::World& world, BindingPlace place, uint64_t address_or_handle,
                      uint64_t bytes_or_count) {
  const uint64_t descriptor[2] = {address_or_handle, bytes_or_count};
  static_assert(sizeof(descriptor) == isa::kDescriptorBytes);
  const size_t at = isa::descriptor_offset(place.first, place.second);
  world.constant_bank.resize(std::max(world.constant_bank.size(), at + sizeof(descriptor)));
  std::memcpy(world.constant_bank.data() + at, descriptor, sizeof(descriptor));
}

void mark_unbound(exec::World& world, const frontend::Binding& binding) {
  const uint32_t count = std::clamp(binding.count, 1u, kMostPlaceholders);
  uint64_t value = isa::unbound_address(binding.set, binding.binding);
  switch (binding.kind) {
    case BindingKind::StorageImage:
    case BindingKind::SampledImage:
      value = world.num_images();
      world.images.insert(world.images.end(), count, image_titled(title(binding)));
      break;
    case BindingKind::Sampler:
      value = world.num_samplers();
      world.samplers.insert(world.samplers.end(), count, sampler_titled(title(binding)));
      break;
    case BindingKind::Other: {  // The address has the number of an image and of a sampler in its low half.
      const size_t number = std::max(world.num_images(), world.num_samplers());
      world.images.resize(number + 1 - world.pool_images(), image_titled(title(binding)));
      world.samplers.resize(number + 1 - world.pool_samplers(), sampler_titled(title(binding)));
      value += number;
      break;
    }
    default:
      break;
  }
  write_descriptor(world, {binding.set, binding.binding}, value, 0);
}

void mark_unbound(exec::World& world, const std::vector<frontend::Binding>& declared,
                  const std::set<BindingPlace>& bound) {
  std::set<BindingPlace> done = bound;
  for (const frontend::Binding& binding : declared)
    if (done.insert({binding.set, binding.binding}).second) mark_unbound(world, binding);
}

void mark_rest_unbound(exec::World& world, const frontend::Binding* array, size_t first) {
  const size_t rest = array && array->count > first ? array->count - first : 0;
  if (rest && array->kind == BindingKind::Sampler)
    world.samplers.insert(world.samplers.end(), rest, sampler_titled(title(*array)));
  else if (rest)
    world.images.insert(world.images.end(), rest, image_titled(title(*array)));
}

void mark_all_unbound(exec::World& world, const std::set<uint32_t>& bound) {
  for (uint32_t i = 0; i < isa::kBindingsPerSet; ++i) {
    if (bound.count(i)) continue;
    frontend::Binding binding;
    binding.binding = i;
    mark_unbound(world, binding);
  }
}

}  // namespace glint::pipeline
