// Tests that the device has what Vulkan 1.3 asks of every device that says 1.3.
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.h"
#include "tests/vulkan/client.h"

namespace glint::test {
namespace {

struct Answers {
  VkPhysicalDeviceVulkan13Features v13{};
  VkPhysicalDeviceVulkan12Features v12{};
  VkPhysicalDeviceVulkan11Features v11{};
  VkPhysicalDeviceFeatures2 core{};
  VkPhysicalDeviceVulkan13Properties p13{};
  VkPhysicalDeviceVulkan12Properties p12{};
  VkPhysicalDeviceVulkan11Properties p11{};
  VkPhysicalDeviceProperties2 properties{};

  explicit Answers(VkPhysicalDevice device) {
    v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, v12.pNext = &v13;
    v11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES, v11.pNext = &v12;
    core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, core.pNext = &v11;
    vkGetPhysicalDeviceFeatures2(device, &core);
    p13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES;
    p12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_PROPERTIES, p12.pNext = &p13;
    p11.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES, p11.pNext = &p12;
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, properties.pNext = &p11;
    vkGetPhysicalDeviceProperties2(device, &properties);
  }
};

TEST_CASE("a device gives the commands of an extension when it is enabled", "[portable]") {
  const Client without;
  CHECK(without.load<PFN_vkVoidFunction>("vkCmdPushDescriptorSetKHR") == nullptr);
  CHECK(without.load<PFN_vkVoidFunction>("vkCmdDispatch") != nullptr);
  const Client with({.extensions = {"VK_KHR_push_descriptor"}});
  CHECK(with.load<PFN_vkVoidFunction>("vkCmdPushDescriptorSetKHR") != nullptr);
}

TEST_CASE("parts of the core are there under their older names, and dispatches ignore what they set") {
  Client client({.extensions = {"VK_EXT_extended_dynamic_state", "VK_EXT_extended_dynamic_state2",
                                "VK_EXT_pipeline_creation_feedback", "VK_EXT_separate_stencil_usage",
                                "VK_EXT_tooling_info", "VK_KHR_draw_indirect_count",
                                "VK_KHR_shader_draw_parameters", "VK_KHR_shader_terminate_invocation"}});
  VkPipelineCreationFeedback whole{VK_PIPELINE_CREATION_FEEDBACK_VALID_BIT, 7}, stage = whole;
  const VkPipelineCreationFeedbackCreateInfo feedback{
      VK_STRUCTURE_TYPE_PIPELINE_CREATION_FEEDBACK_CREATE_INFO, nullptr, &whole, 1, &stage};
  PipelineOptions options{{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
  options.more_info = &feedback;
  const MappedBuffer out = client.buffer(64);
  const ComputePipeline pipeline = client.pipeline(
      "#version 460\nlayout(binding = 0) buffer A { uint a; };\nvoid main() { a = 9; }\n", options);
  // Nothing is known of how the pipeline was made, because it is compiled when it runs.
  CHECK((whole.flags | stage.flags) == 0);
  const VkDescriptorSet set = client.set(pipeline.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});
  REQUIRE(client.run([&](VkCommandBuffer commands) {
    client.load<PFN_vkCmdSetCullModeEXT>("vkCmdSetCullModeEXT")(commands, VK_CULL_MODE_BACK_BIT);
    client.load<PFN_vkCmdSetLogicOpEXT>("vkCmdSetLogicOpEXT")(commands, VK_LOGIC_OP_XOR);
    client.load<PFN_vkCmdSetPatchControlPointsEXT>("vkCmdSetPatchControlPointsEXT")(commands, 3);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &set, 0,
                            nullptr);
    vkCmdDispatch(commands, 1, 1, 1);
  }) == VK_SUCCESS);
  CHECK(out.as<uint32_t>()[0] == 9);
}

TEST_CASE("a device that says Vulkan 1.3 has its required features", "[portable]") {
  const Client client;
  const Answers has(client.physical);
  REQUIRE(has.properties.properties.apiVersion >= VK_API_VERSION_1_3);
  CHECK(has.core.features.robustBufferAccess);
  CHECK(has.v11.multiview);
  CHECK(has.v12.uniformBufferStandardLayout);
  CHECK(has.v12.subgroupBroadcastDynamicId);
  CHECK(has.v12.imagelessFramebuffer);
  CHECK(has.v12.separateDepthStencilLayouts);
  CHECK(has.v12.hostQueryReset);
  CHECK(has.v12.timelineSemaphore);
  CHECK(has.v12.shaderSubgroupExtendedTypes);
  CHECK(has.v12.vulkanMemoryModel);
  CHECK(has.v12.vulkanMemoryModelDeviceScope);
  CHECK(has.v12.bufferDeviceAddress);
  CHECK(has.v13.robustImageAccess);
  CHECK(has.v13.inlineUniformBlock);
  CHECK(has.v13.pipelineCreationCacheControl);
  CHECK(has.v13.privateData);
  CHECK(has.v13.shaderDemoteToHelperInvocation);
  CHECK(has.v13.shaderTerminateInvocation);
  CHECK(has.v13.subgroupSizeControl);
  CHECK(has.v13.computeFullSubgroups);
  CHECK(has.v13.synchronization2);
  CHECK(has.v13.shaderZeroInitializeWorkgroupMemory);
  CHECK(has.v13.dynamicRendering);
  CHECK(has.v13.shaderIntegerDotProduct);
  CHECK(has.v13.maintenance4);
}

TEST_CASE("a device that says Vulkan 1.3 has its required limits", "[portable]") {
  const Client client;
  const Answers has(client.physical);
  const VkPhysicalDeviceLimits& limits = has.properties.properties.limits;
  constexpr VkSampleCountFlags kFour = VK_SAMPLE_COUNT_1_BIT | VK_SAMPLE_COUNT_4_BIT;
  for (const VkSampleCountFlags counts :
       {limits.framebufferColorSampleCounts, limits.framebufferDepthSampleCounts,
        limits.framebufferStencilSampleCounts, limits.framebufferNoAttachmentsSampleCounts,
        limits.sampledImageColorSampleCounts, limits.sampledImageDepthSampleCounts,
        limits.sampledImageStencilSampleCounts})
    CHECK((counts & kFour) == kFour);
  CHECK((limits.sampledImageIntegerSampleCounts & VK_SAMPLE_COUNT_1_BIT) != 0);
  CHECK((limits.storageImageSampleCounts & VK_SAMPLE_COUNT_1_BIT) != 0);
  CHECK(limits.maxComputeSharedMemorySize >= 16384);
  CHECK(limits.maxDescriptorSetInputAttachments >= 4);
  CHECK(has.p11.maxMultiviewViewCount >= 6);
  CHECK(has.p11.maxMemoryAllocationSize >= VkDeviceSize{1} << 30);
  CHECK(has.p12.maxTimelineSemaphoreValueDifference >= (uint64_t{1} << 31) - 1);
  CHECK(has.p13.maxBufferSize >= VkDeviceSize{1} << 30);
  CHECK(has.p13.maxInlineUniformBlockSize >= 256);
  CHECK(has.p13.maxPerStageDescriptorInlineUniformBlocks >= 4);
  CHECK(has.p13.maxPerStageDescriptorUpdateAfterBindInlineUniformBlocks >= 4);
  CHECK(has.p13.maxDescriptorSetInlineUniformBlocks >= 4);
  CHECK(has.p13.maxDescriptorSetUpdateAfterBindInlineUniformBlocks >= 4);
  CHECK(has.p13.maxInlineUniformTotalSize >= 256);
}

// The limits promise several samples only for formats that can be attachments.
TEST_CASE("an image of several samples is promised only where a format can be an attachment", "[portable]") {
  const Client client;
  for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32_SFLOAT, VK_FORMAT_D16_UNORM}) {
    VkFormatProperties can;
    vkGetPhysicalDeviceFormatProperties(client.physical, format, &can);
    const bool is_attachment =
        (can.optimalTilingFeatures &
         (VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT)) != 0;
    VkImageFormatProperties properties{};
    const VkResult result = vkGetPhysicalDeviceImageFormatProperties(
        client.physical, format, VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_OPTIMAL, VK_IMAGE_USAGE_SAMPLED_BIT, 0,
        &properties);
    if (result == VK_SUCCESS)
      CHECK(((properties.sampleCounts & VK_SAMPLE_COUNT_4_BIT) != 0) == is_attachment);
  }
}

// A program that asks for an image in linear tiling would make one that cannot be attached.
TEST_CASE("a use of an image is promised only where its tiling has the feature", "[portable]") {
  const Client client;
  constexpr std::pair<VkFormatFeatureFlags, VkImageUsageFlags> kUses[] = {
      {VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT, VK_IMAGE_USAGE_SAMPLED_BIT},
      {VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT, VK_IMAGE_USAGE_STORAGE_BIT},
      {VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT},
      {VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT}};
  for (int format = VK_FORMAT_R4G4_UNORM_PACK8; format <= VK_FORMAT_ASTC_12x12_SRGB_BLOCK; ++format)
    for (const VkImageTiling tiling : {VK_IMAGE_TILING_OPTIMAL, VK_IMAGE_TILING_LINEAR}) {
      VkFormatProperties can;
      vkGetPhysicalDeviceFormatProperties(client.physical, VkFormat(format), &can);
      const VkFormatFeatureFlags features =
          tiling == VK_IMAGE_TILING_OPTIMAL ? can.optimalTilingFeatures : can.linearTilingFeatures;
      for (const auto& [feature, usage] : kUses) {
        VkImageFormatProperties properties{};
        const VkResult result = vkGetPhysicalDeviceImageFormatProperties(
            client.physical, VkFormat(format), VK_IMAGE_TYPE_2D, tiling, usage, 0, &properties);
        INFO("format " << format << ", tiling " << tiling << ", usage " << usage);
        CHECK((result == VK_SUCCESS) == ((features & feature) != 0));
      }
    }
}

TEST_CASE("a set with more descriptors than the limit says is not supported") {
  const Client client;
  VkPhysicalDeviceMaintenance3Properties limits{};
  limits.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES;
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &limits, {}};
  vkGetPhysicalDeviceProperties2(client.physical, &properties);
  for (const uint32_t more : {0u, 1u}) {
    const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                               limits.maxPerSetDescriptors + more,
                                               VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    const VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, nullptr,
                                               0, 1, &binding};
    VkDescriptorSetLayoutSupport support{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_SUPPORT, nullptr, VK_FALSE};
    vkGetDescriptorSetLayoutSupport(client.device, &info, &support);
    CHECK(support.supported == (more ? VK_FALSE : VK_TRUE));
  }
}

}  // namespace
}  // namespace glint::test
