// What stands where a shader has a binding and nobody bound anything: descriptors whose use is a fault that
// names them.
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

// Choice: Vulkan leaves the use of such a descriptor undefined, with robustBufferAccess too; here it is a
// fault, and let pass it behaves as one outside of a buffer or an image does. Images and samplers are added
// to the world's: whoever binds arrays of them has to do so before.
void mark_unbound(exec::World& world, const frontend::Binding& binding);

// Everything that is declared, and not in `bound`.
void mark_unbound(exec::World& world, const std::vector<frontend::Binding>& declared,
                  const std::set<BindingPlace>& bound);

// The elements from `first` on of an array of images or samplers whose first ones were added just before;
// null: nothing.
void mark_rest_unbound(exec::World& world, const frontend::Binding* array, size_t first);

// For worlds without reflection: all of the first bindings of set 0 that are not in `bound`, whatever their
// kind is.
void mark_all_unbound(exec::World& world, const std::set<uint32_t>& bound);

// Writes a descriptor (isa/descriptors.h); the bank grows where it has to.
void write_descriptor(exec::World& world, BindingPlace place, uint64_t address_or_handle,
                      uint64_t bytes_or_count);

}  // namespace glint::pipeline
