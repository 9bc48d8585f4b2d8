// Walks the pNext chains of Vulkan's structures, and answers its two-call queries.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>

#include "vulkan/handles.h"

namespace glint::vulkan {

// Returns the structure with this sType that hangs on `base`, or null.
template <class Struct, class Base>
const Struct* find_in_chain(const Base* base, VkStructureType type) {
  auto* next = static_cast<const VkBaseInStructure*>(base->pNext);
  while (next && next->sType != type) next = next->pNext;
  return reinterpret_cast<const Struct*>(next);
}
template <class Struct, class Base>
Struct* find_in_output(Base* base, VkStructureType type) {
  auto* next = static_cast<VkBaseOutStructure*>(base->pNext);
  while (next && next->sType != type) next = next->pNext;
  return reinterpret_cast<Struct*>(next);
}

// Calls `visit` with each structure that hangs on `base`.
template <class Base, class Visit>
void for_each_output(Base* base, Visit&& visit) {
  for (auto* next = static_cast<VkBaseOutStructure*>(base->pNext); next; next = next->pNext) visit(next);
}

// Answers a query that is asked twice: without `out` it counts, and with it `put(out[i], i)` fills as many
// elements as there is room for.
template <class Out, class Put>
VkResult enumerate(uint32_t available, uint32_t* count, Out* out, Put&& put) {
  if (!out) {
    *count = available;
    return VK_SUCCESS;
  }
  *count = std::min(*count, available);
  for (uint32_t i = 0; i < *count; ++i) put(out[i], i);
  return *count < available ? VK_INCOMPLETE : VK_SUCCESS;
}

}  // namespace glint::vulkan
