// Records barriers and events. Commands run one after another, so barriers have nothing to do.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "vulkan/command_buffer.h"
#include "vulkan/device.h"
#include "vulkan/sync.h"

namespace glint::vulkan {

void CmdPipelineBarrier(CommandBuffer&, VkPipelineStageFlags, VkPipelineStageFlags, VkDependencyFlags,
                        uint32_t, const VkMemoryBarrier*, uint32_t, const VkBufferMemoryBarrier*, uint32_t,
                        const VkImageMemoryBarrier*) {
}
void CmdPipelineBarrier2(CommandBuffer&, const VkDependencyInfo*) {
}

void CmdSetEvent(CommandBuffer& commands, VkEvent event, VkPipelineStageFlags) {
  commands.record([event](Queue&) { event->is_set = true; });
}
void CmdSetEvent2(CommandBuffer& commands, VkEvent event, const VkDependencyInfo*) {
  CmdSetEvent(commands, event, 0);
}
void CmdResetEvent(CommandBuffer& commands, VkEvent event, VkPipelineStageFlags) {
  commands.record([event](Queue&) { event->is_set = false; });
}
void CmdResetEvent2(CommandBuffer& commands, VkEvent event, VkPipelineStageFlags2) {
  CmdResetEvent(commands, event, 0);
}

// The host may set an event that the queue waits for.
void CmdWaitEvents(CommandBuffer& commands, uint32_t count, const VkEvent* events, VkPipelineStageFlags,
                   VkPipelineStageFlags, uint32_t, const VkMemoryBarrier*, uint32_t,
                   const VkBufferMemoryBarrier*, uint32_t, const VkImageMemoryBarrier*) {
  commands.record_waiting([all = std::vector(events, events + count)](Queue&) {
    return std::all_of(all.begin(), all.end(), [](VkEvent event) { return event->is_set; });
  });
}
void CmdWaitEvents2(CommandBuffer& commands, uint32_t count, const VkEvent* events, const VkDependencyInfo*) {
  CmdWaitEvents(commands, count, events, 0, 0, 0, nullptr, 0, nullptr, 0, nullptr);
}

}  // namespace glint::vulkan
