// Records copies, fills and updates of buffers. The host does them when the queue comes to them.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <vector>

#include "vulkan/command_buffer.h"
#include "vulkan/device.h"
#include "vulkan/memory.h"

namespace glint::vulkan {

void CmdCopyBuffer2(CommandBuffer& commands, const VkCopyBufferInfo2* info) {
  for (uint32_t i = 0; i < info->regionCount; ++i) {
    const VkBufferCopy2& region = info->pRegions[i];
    bytes_of(commands.device, info->srcBuffer, region.srcOffset, region.size);
    bytes_of(commands.device, info->dstBuffer, region.dstOffset, region.size);
    commands.record([from = info->srcBuffer, to = info->dstBuffer, region](Queue& queue) {
      std::memmove(bytes_of(queue.device, to, region.dstOffset, region.size).data,
                   bytes_of(queue.device, from, region.srcOffset, region.size).data, region.size);
      queue.device.clock.add_transfer(2 * region.size);
    });
  }
}

void CmdCopyBuffer(CommandBuffer& commands, VkBuffer from, VkBuffer to, uint32_t count,
                   const VkBufferCopy* regions) {
  std::vector<VkBufferCopy2> all;
  for (uint32_t i = 0; i < count; ++i)
    all.push_back({VK_STRUCTURE_TYPE_BUFFER_COPY_2, nullptr, regions[i].srcOffset, regions[i].dstOffset,
                   regions[i].size});
  const VkCopyBufferInfo2 info{VK_STRUCTURE_TYPE_COPY_BUFFER_INFO_2, nullptr, from, to, count, all.data()};
  CmdCopyBuffer2(commands, &info);
}

void CmdFillBuffer(CommandBuffer& commands, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize bytes,
                   uint32_t word) {
  bytes_of(commands.device, buffer, offset, bytes);
  commands.record([=](Queue& queue) {
    const HostRange to = bytes_of(queue.device, buffer, offset, bytes);
    // The last bytes of a whole buffer that make no word stay as they are.
    std::fill_n(reinterpret_cast<uint32_t*>(to.data), to.bytes / sizeof word, word);
    queue.device.clock.add_transfer(to.bytes);
  });
}

void CmdUpdateBuffer(CommandBuffer& commands, VkBuffer buffer, VkDeviceSize offset, VkDeviceSize bytes,
                     const void* from) {
  bytes_of(commands.device, buffer, offset, bytes);
  const auto* const first = static_cast<const std::byte*>(from);
  commands.record([buffer, offset, data = std::vector(first, first + bytes)](Queue& queue) {
    std::memcpy(bytes_of(queue.device, buffer, offset, data.size()).data, data.data(), data.size());
    queue.device.clock.add_transfer(data.size());
  });
}

}  // namespace glint::vulkan
