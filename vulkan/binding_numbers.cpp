// Finds the bindings of SPIR-V modules by their decorations, and numbers the large ones anew.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/binding_numbers.h"

#include <spirv/unified1/spirv.hpp11>

#include "frontend/spirv/words.h"
#include "isa/descriptors.h"

namespace glint::vulkan {
namespace {

// Says where a variable has its binding, and at which word of the module the number stands.
struct Binding {
  uint32_t set = 0;
  size_t number_at = 0;  // 0: none
};

std::map<uint32_t, Binding> bindings_of(std::span<const uint32_t> spirv) {
  std::map<uint32_t, Binding> out;  // by id
  for (size_t at = frontend::kHeaderWords; at < spirv.size();) {
    const size_t length = spirv[at] >> 16;
    if (length == 0 || length > spirv.size() - at) break;  // The compiler reports this.
    if (frontend::op_of(spirv[at]) == spv::Op::OpDecorate && length == 4) {
      const auto decoration = spv::Decoration(spirv[at + 2]);
      if (decoration == spv::Decoration::DescriptorSet) out[spirv[at + 1]].set = spirv[at + 3];
      if (decoration == spv::Decoration::Binding) out[spirv[at + 1]].number_at = at + 3;
    }
    at += length;
  }
  return out;
}

}  // namespace

void BindingNumbers::note(std::span<const uint32_t> spirv) {
  for (const auto& [id, binding] : bindings_of(spirv))
    if (binding.number_at) used_.insert({binding.set, spirv[binding.number_at]});
}

const std::map<BindingNumbers::Place, uint32_t>& BindingNumbers::changes() {
  for (const Place& place : std::set<Place>(used_)) {
    if (place.second < isa::kMaxBindings || changes_.contains(place)) continue;
    uint32_t number = 0;
    while (used_.contains({place.first, number})) ++number;
    if (number >= isa::kMaxBindings) continue;
    used_.insert({place.first, number});
    changes_[place] = number, originals_[{place.first, number}] = place.second;
  }
  return changes_;
}

std::vector<uint32_t> BindingNumbers::changed(std::span<const uint32_t> spirv) {
  std::vector<uint32_t> out(spirv.begin(), spirv.end());
  const auto& changes = this->changes();
  for (const auto& [id, binding] : bindings_of(spirv)) {
    if (!binding.number_at) continue;
    const auto change = changes.find({binding.set, spirv[binding.number_at]});
    if (change != changes.end()) out[binding.number_at] = change->second;
  }
  return out;
}

uint32_t BindingNumbers::original(uint32_t set, uint32_t binding) const {
  const auto found = originals_.find({set, binding});
  return found == originals_.end() ? binding : found->second;
}

}  // namespace glint::vulkan
