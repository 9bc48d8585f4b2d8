// Fills the descriptors that nobody bound.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/unbound.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <string>
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

exec::ImageView unbound_image(const frontend::Binding& binding) {
  exec::ImageView out;
  out.name = title(binding), out.is_bound = false;
  return out;
}

exec::Sampler unbound_sampler(const frontend::Binding& binding) {
  exec::Sampler out;
  out.unbound = title(binding);
  return out;
}

}  // namespace

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
      value = world.images.size();
      world.images.insert(world.images.end(), count, unbound_image(binding));
      break;
    case BindingKind::Sampler:
      value = world.samplers.size();
      world.samplers.insert(world.samplers.end(), count, unbound_sampler(binding));
      break;
    case BindingKind::Other: {  // The address has the number of an image and of a sampler in its low half.
      const size_t number = std::max(world.images.size(), world.samplers.size());
      world.images.resize(number + 1, unbound_image(binding));
      world.samplers.resize(number + 1, unbound_sampler(binding));
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
    world.samplers.insert(world.samplers.end(), rest, unbound_sampler(*array));
  else if (rest)
    world.images.insert(world.images.end(), rest, unbound_image(*array));
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
