// Records launches of compute shaders.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstring>

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

}  // namespace

void CmdDispatchBase(CommandBuffer& commands, uint32_t base_x, uint32_t base_y, uint32_t base_z, uint32_t x,
                     uint32_t y, uint32_t z) {
  check_pipeline(commands);
  commands.record([bound = commands.bound, base = std::array{base_x, base_y, base_z},
                   groups = std::array{x, y, z}](Queue& queue) { launch(queue, bound, base, groups); });
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
    launch(queue, bound, {}, groups);
  });
}

}  // namespace glint::vulkan
