// Is a small Vulkan program with ray-tracing pipelines and binding tables, on top of ray_client.h.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/vulkan/ray_client.h"

namespace glint::test {

inline constexpr VkShaderStageFlags kAllRayStages =
    VK_SHADER_STAGE_RAYGEN_BIT_KHR | VK_SHADER_STAGE_ANY_HIT_BIT_KHR | VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR |
    VK_SHADER_STAGE_MISS_BIT_KHR | VK_SHADER_STAGE_INTERSECTION_BIT_KHR | VK_SHADER_STAGE_CALLABLE_BIT_KHR;

struct RayShader {
  VkShaderStageFlagBits stage;
  std::string glsl;
  std::string path = {};  // of a file, beside which its includes lie
};
// Holds numbers of shaders, or VK_SHADER_UNUSED_KHR. A group with a general shader has no other one.
struct RayGroup {
  uint32_t general = VK_SHADER_UNUSED_KHR, closest = VK_SHADER_UNUSED_KHR, any = VK_SHADER_UNUSED_KHR,
           intersection = VK_SHADER_UNUSED_KHR;
};
struct RayPipelineOrder {
  std::vector<RayShader> shaders;
  std::vector<RayGroup> groups;
  std::vector<VkPipeline> libraries;
  VkPipelineCreateFlags flags = 0;
  bool has_dynamic_stack = false;
  uint32_t depth = 2;
};

// Holds the records of a table: groups of the pipeline, in regions with a stride of 64 bytes.
struct RayTable {
  VkStridedDeviceAddressRegionKHR raygen{}, miss{}, hit{}, callable{};
  MappedBuffer bytes;
};

class RayPipelineClient : public RayClient {
 public:
  RayPipelineClient();

  // Returns a layout of one set: binding 0 is a structure, and those from 1 on are buffers.
  VkPipelineLayout layout(uint32_t buffers);
  VkPipeline ray_pipeline(const RayPipelineOrder& order);
  RayTable table(VkPipeline pipeline, uint32_t raygen, const std::vector<uint32_t>& miss,
                 const std::vector<uint32_t>& hit, const std::vector<uint32_t>& callable = {});
  std::vector<uint8_t> handles(VkPipeline pipeline, uint32_t groups);
  // Binds a pipeline and a set. The caller traces.
  void bind(VkCommandBuffer commands, VkPipeline pipeline, VkDescriptorSet set);
  VkResult trace(VkPipeline pipeline, VkDescriptorSet set, const RayTable& table,
                 std::array<uint32_t, 3> size);

  VkDescriptorSetLayout set_layout = nullptr;
  VkPipelineLayout pipeline_layout = nullptr;
  PFN_vkCmdTraceRaysKHR cmd_trace;
  PFN_vkCmdTraceRaysIndirectKHR cmd_trace_indirect;
  PFN_vkCmdTraceRaysIndirect2KHR cmd_trace_indirect2;
  PFN_vkCmdSetRayTracingPipelineStackSizeKHR cmd_set_stack;
  PFN_vkGetRayTracingShaderGroupStackSizeKHR stack_size;

 private:
  PFN_vkCreateRayTracingPipelinesKHR create_;
  PFN_vkGetRayTracingShaderGroupHandlesKHR handles_;
};

}  // namespace glint::test
