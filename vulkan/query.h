// Holds query pools: timestamps, properties of acceleration structures, and what commands did.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "vulkan/handles.h"

struct VkQueryPool_T {
  VkQueryType type = VK_QUERY_TYPE_TIMESTAMP;
  VkQueryPipelineStatisticFlags statistics = 0;  // of pools of statistics
  std::vector<std::optional<uint64_t>> values;   // nothing: not available
  std::vector<uint64_t> begun;                   // what a query of commands counts from
};

namespace glint::vulkan {

// Throws Refusal when the pool does not have these queries.
void check_range(VkQueryPool pool, uint32_t first, uint32_t count);

}  // namespace glint::vulkan
