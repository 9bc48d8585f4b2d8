// Is a small Vulkan program with ray-tracing pipelines and binding tables, on top of ray_client.h.
// SPDX-License-Identifier: Apache-2.0
#include "tests/vulkan/ray_pipeline_client.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace glint::test {
namespace {

constexpr uint32_t kHandle = 32, kStride = 64;

const void* features() {
  static VkPhysicalDeviceRayTracingMaintenance1FeaturesKHR more{};
  static VkPhysicalDeviceRayTracingPipelineFeaturesKHR wanted{};
  more.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_MAINTENANCE_1_FEATURES_KHR;
  more.rayTracingMaintenance1 = more.rayTracingPipelineTraceRaysIndirect2 = VK_TRUE;
  wanted.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR, wanted.pNext = &more;
  wanted.rayTracingPipeline = wanted.rayTracingPipelineTraceRaysIndirect = VK_TRUE;
  wanted.rayTraversalPrimitiveCulling = VK_TRUE;
  return &wanted;
}

}  // namespace

RayPipelineClient::RayPipelineClient()
    : RayClient({VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME, VK_KHR_RAY_TRACING_MAINTENANCE_1_EXTENSION_NAME,
                 VK_KHR_PIPELINE_LIBRARY_EXTENSION_NAME},
                features()) {
  create_ = load<PFN_vkCreateRayTracingPipelinesKHR>("vkCreateRayTracingPipelinesKHR");
  handles_ = load<PFN_vkGetRayTracingShaderGroupHandlesKHR>("vkGetRayTracingShaderGroupHandlesKHR");
  cmd_trace = load<PFN_vkCmdTraceRaysKHR>("vkCmdTraceRaysKHR");
  cmd_trace_indirect = load<PFN_vkCmdTraceRaysIndirectKHR>("vkCmdTraceRaysIndirectKHR");
  cmd_trace_indirect2 = load<PFN_vkCmdTraceRaysIndirect2KHR>("vkCmdTraceRaysIndirect2KHR");
  cmd_set_stack = load<PFN_vkCmdSetRayTracingPipelineStackSizeKHR>("vkCmdSetRayTracingPipelineStackSizeKHR");
  stack_size = load<PFN_vkGetRayTracingShaderGroupStackSizeKHR>("vkGetRayTracingShaderGroupStackSizeKHR");
  pipeline_layout = layout(1);
}

VkPipelineLayout RayPipelineClient::layout(uint32_t buffers) {
  std::vector<VkDescriptorSetLayoutBinding> bindings{
      {0, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1, kAllRayStages, nullptr}};
  for (uint32_t i = 0; i < buffers; ++i)
    bindings.push_back({i + 1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, kAllRayStages, nullptr});
  VkDescriptorSetLayoutCreateInfo sets{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, nullptr, 0,
                                       uint32_t(bindings.size()), bindings.data()};
  check(vkCreateDescriptorSetLayout(device, &sets, nullptr, &set_layout), "vkCreateDescriptorSetLayout");
  const VkPushConstantRange range{kAllRayStages, 0, 64};
  VkPipelineLayoutCreateInfo info{
      VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, nullptr, 0, 1, &set_layout, 1, &range};
  VkPipelineLayout out = nullptr;
  check(vkCreatePipelineLayout(device, &info, nullptr, &out), "vkCreatePipelineLayout");
  at_end([this, out, set = set_layout] {
    vkDestroyPipelineLayout(device, out, nullptr);
    vkDestroyDescriptorSetLayout(device, set, nullptr);
  });
  return out;
}

VkPipeline RayPipelineClient::ray_pipeline(const RayPipelineOrder& order) {
  std::vector<VkPipelineShaderStageCreateInfo> stages;
  for (const RayShader& each : order.shaders)
    stages.push_back({VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, each.stage,
                      module(each.glsl, each.stage, each.path), "main", nullptr});
  std::vector<VkRayTracingShaderGroupCreateInfoKHR> groups;
  for (const RayGroup& each : order.groups) {
    const VkRayTracingShaderGroupTypeKHR type =
        each.general != VK_SHADER_UNUSED_KHR ? VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR
        : each.intersection != VK_SHADER_UNUSED_KHR
            ? VK_RAY_TRACING_SHADER_GROUP_TYPE_PROCEDURAL_HIT_GROUP_KHR
            : VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR;
    groups.push_back({VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR, nullptr, type, each.general,
                      each.closest, each.any, each.intersection, nullptr});
  }
  const VkPipelineLibraryCreateInfoKHR libraries{VK_STRUCTURE_TYPE_PIPELINE_LIBRARY_CREATE_INFO_KHR, nullptr,
                                                 uint32_t(order.libraries.size()), order.libraries.data()};
  const VkRayTracingPipelineInterfaceCreateInfoKHR interface {
    VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_INTERFACE_CREATE_INFO_KHR, nullptr, 64, 32
  };
  const VkDynamicState dynamic = VK_DYNAMIC_STATE_RAY_TRACING_PIPELINE_STACK_SIZE_KHR;
  const VkPipelineDynamicStateCreateInfo states{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO, nullptr,
                                                0, 1, &dynamic};
  const bool uses_libraries = !order.libraries.empty() || (order.flags & VK_PIPELINE_CREATE_LIBRARY_BIT_KHR);
  VkRayTracingPipelineCreateInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR, info.flags = order.flags;
  info.stageCount = uint32_t(stages.size()), info.pStages = stages.data();
  info.groupCount = uint32_t(groups.size()), info.pGroups = groups.data();
  info.maxPipelineRayRecursionDepth = order.depth, info.layout = pipeline_layout;
  if (uses_libraries) info.pLibraryInfo = &libraries, info.pLibraryInterface = &interface;
  if (order.has_dynamic_stack) info.pDynamicState = &states;
  VkPipeline out = nullptr;
  check(create_(device, nullptr, nullptr, 1, &info, nullptr, &out), "vkCreateRayTracingPipelinesKHR");
  at_end([this, out] { vkDestroyPipeline(device, out, nullptr); });
  return out;
}

std::vector<uint8_t> RayPipelineClient::handles(VkPipeline pipeline, uint32_t groups) {
  std::vector<uint8_t> out(size_t(groups) * kHandle);
  check(handles_(device, pipeline, 0, groups, out.size(), out.data()),
        "vkGetRayTracingShaderGroupHandlesKHR");
  return out;
}

RayTable RayPipelineClient::table(VkPipeline pipeline, uint32_t raygen, const std::vector<uint32_t>& miss,
                                  const std::vector<uint32_t>& hit, const std::vector<uint32_t>& callable) {
  RayTable out;
  out.bytes =
      buffer(4096, VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR);
  VkDeviceSize at = 0;
  const auto place = [&](const std::vector<uint32_t>& groups) {
    const VkStridedDeviceAddressRegionKHR region{address(out.bytes) + at, kStride, groups.size() * kStride};
    for (const uint32_t group : groups) {
      const std::vector<uint8_t> all = handles(pipeline, group + 1);
      std::memcpy(static_cast<std::byte*>(out.bytes.data) + at, all.data() + group * kHandle, kHandle);
      at += kStride;
    }
    return groups.empty() ? VkStridedDeviceAddressRegionKHR{} : region;
  };
  out.raygen = place({raygen}), out.miss = place(miss), out.hit = place(hit), out.callable = place(callable);
  return out;
}

void RayPipelineClient::bind(VkCommandBuffer commands, VkPipeline pipeline, VkDescriptorSet set) {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, pipeline);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, pipeline_layout, 0, 1, &set, 0,
                          nullptr);
}

VkResult RayPipelineClient::trace(VkPipeline pipeline, VkDescriptorSet set, const RayTable& table,
                                  std::array<uint32_t, 3> size) {
  return run([&](VkCommandBuffer commands) {
    bind(commands, pipeline, set);
    cmd_trace(commands, &table.raygen, &table.miss, &table.hit, &table.callable, size[0], size[1], size[2]);
  });
}

}  // namespace glint::test
