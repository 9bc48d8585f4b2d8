// Holds query pools: timestamps, and properties of acceleration structures.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "vulkan/handles.h"

struct VkQueryPool_T {
  std::vector<std::optional<uint64_t>> values;  // nothing: not available
};

namespace glint::vulkan {

// Throws Refusal when the pool does not have these queries.
void check_range(VkQueryPool pool, uint32_t first, uint32_t count);

}  // namespace glint::vulkan
