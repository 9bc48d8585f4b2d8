// Gives bindings with large numbers smaller ones, of which the simulated GPU has isa::kMaxBindings a set.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace glint::vulkan {

// Holds the numbers of all bindings that the shaders of a pipeline have.
class BindingNumbers {
 public:
  using Place = std::pair<uint32_t, uint32_t>;  // set and binding

  // Notes the bindings of a module. All modules are noted before one is changed.
  void note(std::span<const uint32_t> spirv);
  // Returns the new numbers by place, or nothing where no binding is too large. A new number is the lowest
  // that its set has free. When none is free, the binding stays as it is, and the compiler refuses it.
  const std::map<Place, uint32_t>& changes();
  // Returns the module with the new numbers.
  std::vector<uint32_t> changed(std::span<const uint32_t> spirv);
  // Returns the number that the application gave to a binding of the changed modules.
  uint32_t original(uint32_t set, uint32_t binding) const;

 private:
  std::set<Place> used_;
  std::map<Place, uint32_t> changes_, originals_;
};

}  // namespace glint::vulkan
