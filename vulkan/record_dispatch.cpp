// Records launches of compute shaders.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>

#include "vulkan/command_buffer.h"
#include "vulkan/device.h"
#include "vulkan/launch.h"
#include "vulkan/memory.h"
#include "vulkan/pipeline.h"

namespace glint::vulkan {
namespace {

void check_pipeline(const CommandBuffer& commands) {
  if (!commands.bound.pipeline || commands.bound.pipeline->rays)
    throw Refusal("no compute pipeline is bound");
}

// Throws Refusal when the numbers of the blocks leave what the device announces. A launch of 2^30 blocks
// would run for hours.
void check_groups(const Device& device, const std::array<uint32_t, 3>& base,
                  const std::array<uint32_t, 3>& groups) {
  for (size_t axis = 0; axis < 3; ++axis) {
    const uint32_t most = device.physical.core.limits.maxComputeWorkGroupCount[axis];
    if (groups[axis] <= most && base[axis] <= most - groups[axis]) continue;
    throw Refusal(fmt::format(
        "a dispatch of {} x {} x {} workgroups from ({}, {}, {}) is too large: there may be {} on "
        "an axis (maxComputeWorkGroupCount)",
        groups[0], groups[1], groups[2], base[0], base[1], base[2], most));
  }
}

}  // namespace

void CmdDispatchBase(CommandBuffer& commands, uint32_t base_x, uint32_t base_y, uint32_t base_z, uint32_t x,
                     uint32_t y, uint32_t z) {
  check_pipeline(commands);
  const std::array base{base_x, base_y, base_z}, groups{x, y, z};
  check_groups(commands.device, base, groups);
  commands.record(
      [bound = commands.bound, base, groups](Queue& queue) { launch(queue, bound, base, groups); });
}

void CmdDispatch(CommandBuffer& commands, uint32_t x, uint32_t y, uint32_t z) {
  CmdDispatchBase(commands, 0, 0, 0, x, y, z);
}

void CmdDispatchIndirect(CommandBuffer& commands, VkBuffer buffer, VkDeviceSize offset) {
  check_pipeline(commands);
  bytes_of(commands.device, buffer, offset, sizeof(VkDispatchIndirectCommand));
  commands.record([bound = commands.bound, buffer, offset](Queue& queue) {
    std::array<uint32_t, 3> groups{};
    std::memcpy(groups.data(), bytes_of(queue.device, buffer, offset, sizeof groups).data, sizeof groups);
    check_groups(queue.device, {}, groups);
    launch(queue, bound, {}, groups);
  });
}

}  // namespace glint::vulkan
