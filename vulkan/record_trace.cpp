// Records launches of rays.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>

#include "vulkan/command_buffer.h"
#include "vulkan/device.h"
#include "vulkan/launch.h"
#include "vulkan/pipeline.h"

namespace glint::vulkan {
namespace {

constexpr uint64_t kStackAlignment = 16;

void check_ray_pipeline(const CommandBuffer& commands) {
  if (!commands.bound_for_rays.pipeline || !commands.bound_for_rays.pipeline->rays)
    throw Refusal("no ray-tracing pipeline is bound");
}

void check_size(const std::array<uint32_t, 3>& size) {
  uint64_t rays = 1;
  for (const uint32_t each : size) {
    rays *= each;
    if (rays > kMaxRays)
      throw Refusal(fmt::format("a launch of {} x {} x {} rays is too large: it may have {}", size[0],
                                size[1], size[2], kMaxRays));
  }
}

pipeline::DeviceRegion region_of(const VkStridedDeviceAddressRegionKHR& from) {
  return {from.deviceAddress, from.stride, from.size};
}

pipeline::DeviceTable table_of(const VkStridedDeviceAddressRegionKHR* raygen,
                               const VkStridedDeviceAddressRegionKHR* miss,
                               const VkStridedDeviceAddressRegionKHR* hit,
                               const VkStridedDeviceAddressRegionKHR* callable) {
  return {region_of(*raygen), region_of(*miss), region_of(*hit), region_of(*callable)};
}

// Returns what the device has put at an address. Throws Refusal when it is not in memory.
template <class Command>
Command command_at(const Queue& queue, VkDeviceAddress at) {
  Command out;
  const std::byte* const from = queue.device.memory.find(at, sizeof out);
  if (!from) throw Refusal(fmt::format("no size of an indirect launch of rays lies at address {:#x}", at));
  std::memcpy(&out, from, sizeof out);
  return out;
}

}  // namespace

void CmdTraceRaysKHR(CommandBuffer& commands, const VkStridedDeviceAddressRegionKHR* raygen,
                     const VkStridedDeviceAddressRegionKHR* miss, const VkStridedDeviceAddressRegionKHR* hit,
                     const VkStridedDeviceAddressRegionKHR* callable, uint32_t width, uint32_t height,
                     uint32_t depth) {
  check_ray_pipeline(commands);
  const std::array size{width, height, depth};
  check_size(size);
  commands.record([bound = commands.bound_for_rays, table = table_of(raygen, miss, hit, callable),
                   size](Queue& queue) { launch_rays(queue, bound, table, size); });
}

void CmdTraceRaysIndirectKHR(CommandBuffer& commands, const VkStridedDeviceAddressRegionKHR* raygen,
                             const VkStridedDeviceAddressRegionKHR* miss,
                             const VkStridedDeviceAddressRegionKHR* hit,
                             const VkStridedDeviceAddressRegionKHR* callable, VkDeviceAddress at) {
  check_ray_pipeline(commands);
  commands.record(
      [bound = commands.bound_for_rays, table = table_of(raygen, miss, hit, callable), at](Queue& queue) {
        const auto command = command_at<VkTraceRaysIndirectCommandKHR>(queue, at);
        const std::array size{command.width, command.height, command.depth};
        check_size(size);
        launch_rays(queue, bound, table, size);
      });
}

void CmdTraceRaysIndirect2KHR(CommandBuffer& commands, VkDeviceAddress at) {
  check_ray_pipeline(commands);
  commands.record([bound = commands.bound_for_rays, at](Queue& queue) {
    const auto from = command_at<VkTraceRaysIndirectCommand2KHR>(queue, at);
    const std::array size{from.width, from.height, from.depth};
    check_size(size);
    const pipeline::DeviceTable table{
        {from.raygenShaderRecordAddress, 0, from.raygenShaderRecordSize},
        {from.missShaderBindingTableAddress, from.missShaderBindingTableStride,
         from.missShaderBindingTableSize},
        {from.hitShaderBindingTableAddress, from.hitShaderBindingTableStride, from.hitShaderBindingTableSize},
        {from.callableShaderBindingTableAddress, from.callableShaderBindingTableStride,
         from.callableShaderBindingTableSize}};
    launch_rays(queue, bound, table, size);
  });
}

void CmdSetRayTracingPipelineStackSizeKHR(CommandBuffer& commands, uint32_t bytes) {
  commands.bound_for_rays.stack_bytes =
      uint32_t((bytes + kStackAlignment - 1) / kStackAlignment * kStackAlignment);
}

}  // namespace glint::vulkan
