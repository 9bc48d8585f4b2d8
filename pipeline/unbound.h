// Fills bindings that nobody bound with descriptors whose use is a fault that names them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "exec/image.h"
#include "frontend/spirv/reflection.h"

namespace glint::pipeline {

using BindingPlace = std::pair<uint32_t, uint32_t>;  // set, binding

// Return what stands for an element of an array that nobody bound.
exec::ImageView unbound_image(BindingPlace place);
exec::Sampler unbound_sampler(BindingPlace place);

// Returns what stands for an image that the host has left out on purpose. Its use is no fault.
exec::ImageView null_image();

// Fills one binding. Images and samplers are added to the world's, so whoever binds arrays of them has to do
// so before. Choice: Vulkan leaves the use of such a descriptor undefined, even with robustBufferAccess. Here
// it is a fault, and a fault that is let pass behaves as an access outside of a buffer or an image.
void mark_unbound(exec::World& world, const frontend::Binding& binding);

// Fills every declared binding that is not in `bound`.
void mark_unbound(exec::World& world, const std::vector<frontend::Binding>& declared,
                  const std::set<BindingPlace>& bound);

// Fills the elements from `first` on of an array of images or samplers whose first ones were added just
// before. A null `array` does nothing.
void mark_rest_unbound(exec::World& world, const frontend::Binding* array, size_t first);

// Fills all of the first bindings of set 0 that are not in `bound`, whatever their kind is. It serves worlds
// without reflection.
void mark_all_unbound(exec::World& world, const std::set<uint32_t>& bound);

// Writes a descriptor (isa/descriptors.h). The constant bank grows when it has to.
void write_descriptor(exec::World& world, BindingPlace place, uint64_t address_or_handle,
                      uint64_t bytes_or_count);

}  // namespace glint::pipeline
