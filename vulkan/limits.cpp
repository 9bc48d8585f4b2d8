// Says the limits and the properties of the device: what the simulated GPU has, and what Vulkan asks for at
// least where nothing depends on the GPU.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <fmt/format.h>

#include "core/reorder.h"
#include "exec/block.h"
#include "isa/descriptors.h"
#include "pipeline/binding_table.h"
#include "rtunit/structure/micromaps.h"
#include "vulkan/descriptor_buffer.h"
#include "vulkan/image.h"
#include "vulkan/instance.h"

namespace glint::vulkan {
namespace {

constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_RAYGEN_BIT_KHR |
                                       VK_SHADER_STAGE_ANY_HIT_BIT_KHR | VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR |
                                       VK_SHADER_STAGE_MISS_BIT_KHR | VK_SHADER_STAGE_INTERSECTION_BIT_KHR |
                                       VK_SHADER_STAGE_CALLABLE_BIT_KHR;
// Choice: launches have threads of 32-bit numbers, so a whole axis of the largest blocks fits.
constexpr uint32_t kMaxGroups = (1u << 22) - 1;

void set_image_limits(VkPhysicalDeviceLimits& l) {
  l.maxImageDimension1D = l.maxImageDimension2D = l.maxImageDimensionCube = 16384;
  l.maxImageDimension3D = 2048;
  l.maxImageArrayLayers = 2048;
  l.maxTexelBufferElements = 1u << 27;
  l.maxSamplerAllocationCount = 4000;
  l.maxSamplerLodBias = 16.0f, l.maxSamplerAnisotropy = float(exec::kMaxAnisotropy);
  l.subPixelPrecisionBits = l.subTexelPrecisionBits = l.mipmapPrecisionBits = 8;
  l.minTexelOffset = l.minTexelGatherOffset = -32;
  l.maxTexelOffset = l.maxTexelGatherOffset = 31;
  l.sampledImageColorSampleCounts = l.sampledImageDepthSampleCounts = kSamples;
  l.sampledImageStencilSampleCounts = l.sampledImageIntegerSampleCounts = kSamples;
  l.storageImageSampleCounts = kSamples;
  l.maxSampleMaskWords = 1;
}

void set_descriptor_limits(VkPhysicalDeviceLimits& l) {
  l.maxBoundDescriptorSets = isa::kMaxSets;
  for (uint32_t* limit :
       {&l.maxPerStageDescriptorSamplers, &l.maxPerStageDescriptorUniformBuffers,
        &l.maxPerStageDescriptorStorageBuffers, &l.maxPerStageDescriptorSampledImages,
        &l.maxPerStageDescriptorStorageImages, &l.maxPerStageResources, &l.maxDescriptorSetSamplers,
        &l.maxDescriptorSetUniformBuffers, &l.maxDescriptorSetStorageBuffers,
        &l.maxDescriptorSetSampledImages, &l.maxDescriptorSetStorageImages})
    *limit = kManyDescriptors;
  l.maxDescriptorSetUniformBuffersDynamic = l.maxDescriptorSetStorageBuffersDynamic = 64;
}

void set_memory_limits(VkPhysicalDeviceLimits& l) {
  l.maxUniformBufferRange = l.maxStorageBufferRange = 0xffff'ffff;
  l.maxPushConstantsSize = kMaxPushConstantBytes;
  l.maxMemoryAllocationCount = 16384;
  l.bufferImageGranularity = 1;
  l.minMemoryMapAlignment = 64;
  l.minTexelBufferOffsetAlignment = 16;
  l.minUniformBufferOffsetAlignment = l.minStorageBufferOffsetAlignment = 16;
  l.optimalBufferCopyOffsetAlignment = l.optimalBufferCopyRowPitchAlignment = 1;
  l.nonCoherentAtomSize = 64;
}

// Sets what only graphics queues use to the least that Vulkan allows. Clients such as vulkaninfo show it.
void set_graphics_limits(VkPhysicalDeviceLimits& l) {
  l.maxFramebufferWidth = l.maxFramebufferHeight = 4096;
  l.maxFramebufferLayers = 256;
  l.maxColorAttachments = l.maxFragmentOutputAttachments = 4;
  l.maxPerStageDescriptorInputAttachments = l.maxDescriptorSetInputAttachments = 4;
  l.framebufferColorSampleCounts = l.framebufferDepthSampleCounts = kSamples;
  l.framebufferStencilSampleCounts = l.framebufferNoAttachmentsSampleCounts = kSamples;
  l.maxViewports = 1;
  l.maxViewportDimensions[0] = l.maxViewportDimensions[1] = 4096;
  l.viewportBoundsRange[0] = -8192, l.viewportBoundsRange[1] = 8191;
  l.maxVertexInputAttributes = l.maxVertexInputBindings = 16;
  l.maxVertexInputAttributeOffset = 2047, l.maxVertexInputBindingStride = 2048;
  l.maxVertexOutputComponents = l.maxFragmentInputComponents = 64;
  l.maxFragmentCombinedOutputResources = 4;
  l.maxDrawIndexedIndexValue = (1u << 24) - 1, l.maxDrawIndirectCount = 1;
  l.pointSizeRange[0] = l.pointSizeRange[1] = l.lineWidthRange[0] = l.lineWidthRange[1] = 1.0f;
  l.discreteQueuePriorities = 2;
}

// Raises what programs ask of graphics before they compute: the least that WebGPU wants of a device.
void set_universal_limits(VkPhysicalDeviceLimits& l) {
  l.maxFramebufferWidth = l.maxFramebufferHeight = 16384;
  l.maxViewportDimensions[0] = l.maxViewportDimensions[1] = 16384;
  l.viewportBoundsRange[0] = -32768, l.viewportBoundsRange[1] = 32767;
  l.maxColorAttachments = l.maxFragmentOutputAttachments = 8;
  l.maxFragmentCombinedOutputResources = 32;
  l.maxVertexOutputComponents = l.maxFragmentInputComponents = 128;
  l.maxDrawIndexedIndexValue = 0xffff'ffff, l.maxDrawIndirectCount = 1 << 16;
  l.lineWidthRange[1] = 8.0f, l.lineWidthGranularity = 1.0f;
  l.maxViewports = 16, l.pointSizeRange[1] = 64.0f, l.pointSizeGranularity = 1.0f;
  l.maxClipDistances = l.maxCullDistances = l.maxCombinedClipAndCullDistances = 8;
  l.maxTessellationGenerationLevel = 64, l.maxTessellationPatchSize = 32;
  l.maxTessellationControlPerVertexInputComponents = l.maxTessellationControlPerVertexOutputComponents = 64;
  l.maxTessellationControlPerPatchOutputComponents = 120;
  l.maxTessellationControlTotalOutputComponents = 2048;
  l.maxTessellationEvaluationInputComponents = l.maxTessellationEvaluationOutputComponents = 64;
  l.maxGeometryShaderInvocations = 32, l.maxGeometryOutputVertices = 256;
  l.maxGeometryInputComponents = l.maxGeometryOutputComponents = 64;
  l.maxGeometryTotalOutputComponents = 1024;
}

template <size_t N>
void set_text(char (&to)[N], const std::string& text) {
  std::strncpy(to, text.c_str(), N - 1);
}

void set_subgroups(DeviceProperties& p) {
  p.subgroupSize = p.minSubgroupSize = p.maxSubgroupSize = uint32_t(kLanes);
  p.maxComputeWorkgroupSubgroups = exec::kMaxBlockWarps;
  p.supportedStages = p.subgroupSupportedStages = p.requiredSubgroupSizeStages = kStages;
  p.supportedOperations = p.subgroupSupportedOperations =
      VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT |
      VK_SUBGROUP_FEATURE_BALLOT_BIT | VK_SUBGROUP_FEATURE_SHUFFLE_BIT |
      VK_SUBGROUP_FEATURE_SHUFFLE_RELATIVE_BIT | VK_SUBGROUP_FEATURE_CLUSTERED_BIT |
      VK_SUBGROUP_FEATURE_QUAD_BIT;
  p.quadOperationsInAllStages = p.subgroupQuadOperationsInAllStages = VK_TRUE;
}

// Floats keep denormals, signed zeros, infinities and NaN, and round to nearest even.
void set_floats(DeviceProperties& p) {
  p.denormBehaviorIndependence = p.roundingModeIndependence = VK_SHADER_FLOAT_CONTROLS_INDEPENDENCE_ALL;
  p.shaderSignedZeroInfNanPreserveFloat16 = p.shaderSignedZeroInfNanPreserveFloat32 = VK_TRUE;
  p.shaderSignedZeroInfNanPreserveFloat64 = VK_TRUE;
  p.shaderDenormPreserveFloat16 = p.shaderDenormPreserveFloat32 = p.shaderDenormPreserveFloat64 = VK_TRUE;
  p.shaderRoundingModeRTEFloat16 = p.shaderRoundingModeRTEFloat32 = p.shaderRoundingModeRTEFloat64 = VK_TRUE;
}

// An inline uniform block is a uniform buffer that a descriptor set holds itself.
void set_inline_uniform_blocks(DeviceProperties& p) {
  p.maxInlineUniformBlockSize = p.maxInlineUniformTotalSize = 1 << 16;
  p.maxPerStageDescriptorInlineUniformBlocks = p.maxDescriptorSetInlineUniformBlocks = 64;
  p.maxPerStageDescriptorUpdateAfterBindInlineUniformBlocks = 64;
  p.maxDescriptorSetUpdateAfterBindInlineUniformBlocks = 64;
}

void set_descriptor_indexing(DeviceProperties& p) {
  p.maxUpdateAfterBindDescriptorsInAllPools = p.maxPerSetDescriptors = kManyDescriptors;
  p.shaderUniformBufferArrayNonUniformIndexingNative = VK_TRUE;
  p.shaderSampledImageArrayNonUniformIndexingNative = VK_TRUE;
  p.shaderStorageBufferArrayNonUniformIndexingNative = VK_TRUE;
  p.shaderStorageImageArrayNonUniformIndexingNative = VK_TRUE;
  p.robustBufferAccessUpdateAfterBind = p.quadDivergentImplicitLod = VK_TRUE;
  for (uint32_t* limit :
       {&p.maxPerStageDescriptorUpdateAfterBindSamplers,
        &p.maxPerStageDescriptorUpdateAfterBindUniformBuffers,
        &p.maxPerStageDescriptorUpdateAfterBindStorageBuffers,
        &p.maxPerStageDescriptorUpdateAfterBindSampledImages,
        &p.maxPerStageDescriptorUpdateAfterBindStorageImages, &p.maxPerStageUpdateAfterBindResources,
        &p.maxDescriptorSetUpdateAfterBindSamplers, &p.maxDescriptorSetUpdateAfterBindUniformBuffers,
        &p.maxDescriptorSetUpdateAfterBindStorageBuffers, &p.maxDescriptorSetUpdateAfterBindSampledImages,
        &p.maxDescriptorSetUpdateAfterBindStorageImages})
    *limit = kManyDescriptors;
  p.maxDescriptorSetUpdateAfterBindUniformBuffersDynamic = 64;
  p.maxDescriptorSetUpdateAfterBindStorageBuffersDynamic = 64;
  p.maxPerStageDescriptorUpdateAfterBindInputAttachments = 4;
  p.maxDescriptorSetUpdateAfterBindInputAttachments = 4;
  p.maxPushDescriptors = 32;
}

// Descriptors in buffers are all of one size.
void set_descriptor_buffers(DeviceProperties& p) {
  p.combinedImageSamplerDescriptorSingleArray = p.bufferlessPushDescriptors = VK_TRUE;
  p.descriptorBufferOffsetAlignment = kStoredBytes;
  p.maxDescriptorBufferBindings = p.maxResourceDescriptorBufferBindings = 32;
  p.maxSamplerDescriptorBufferBindings = p.maxEmbeddedImmutableSamplerBindings = 32;
  p.maxEmbeddedImmutableSamplers = kManyDescriptors;
  for (size_t* bytes :
       {&p.bufferCaptureReplayDescriptorDataSize, &p.imageCaptureReplayDescriptorDataSize,
        &p.imageViewCaptureReplayDescriptorDataSize, &p.samplerCaptureReplayDescriptorDataSize,
        &p.accelerationStructureCaptureReplayDescriptorDataSize})
    *bytes = sizeof(uint64_t);
  for (size_t* bytes :
       {&p.samplerDescriptorSize, &p.combinedImageSamplerDescriptorSize, &p.sampledImageDescriptorSize,
        &p.storageImageDescriptorSize, &p.uniformTexelBufferDescriptorSize,
        &p.robustUniformTexelBufferDescriptorSize, &p.storageTexelBufferDescriptorSize,
        &p.robustStorageTexelBufferDescriptorSize, &p.uniformBufferDescriptorSize,
        &p.robustUniformBufferDescriptorSize, &p.storageBufferDescriptorSize,
        &p.robustStorageBufferDescriptorSize, &p.inputAttachmentDescriptorSize,
        &p.accelerationStructureDescriptorSize, &p.combinedImageSamplerDensityMapDescriptorSize})
    *bytes = kStoredBytes;
  for (VkDeviceSize* range :
       {&p.maxSamplerDescriptorBufferRange, &p.maxResourceDescriptorBufferRange,
        &p.samplerDescriptorBufferAddressSpaceSize, &p.resourceDescriptorBufferAddressSpaceSize,
        &p.descriptorBufferAddressSpaceSize})
    *range = kMaxAllocationBytes;
}

void set_acceleration_structures(DeviceProperties& p) {
  p.maxGeometryCount = p.maxInstanceCount = (1u << 24) - 1;
  p.maxPrimitiveCount = (1u << 29) - 1;
  for (uint32_t* limit :
       {&p.maxPerStageDescriptorAccelerationStructures,
        &p.maxPerStageDescriptorUpdateAfterBindAccelerationStructures,
        &p.maxDescriptorSetAccelerationStructures, &p.maxDescriptorSetUpdateAfterBindAccelerationStructures})
    *limit = kManyDescriptors;
  p.minAccelerationStructureScratchOffsetAlignment = 64;
  p.maxOpacity2StateSubdivisionLevel = p.maxOpacity4StateSubdivisionLevel = rt::MicromapFormat::kMostLevels;
}

void set_ray_pipelines(DeviceProperties& p, const pipeline::GpuParams& gpu) {
  p.shaderGroupHandleSize = p.shaderGroupHandleCaptureReplaySize = exec::kHandleBytes;
  p.shaderGroupHandleAlignment = pipeline::kHandleAlignment;
  p.shaderGroupBaseAlignment = pipeline::kBaseAlignment;
  p.maxShaderGroupStride = pipeline::kMaxStride;
  p.maxRayRecursionDepth = kMaxRayRecursion;
  p.maxRayDispatchInvocationCount = kMaxRays;
  p.maxRayHitAttributeSize = 32;
  const bool reorders = gpu.core.reorder.make({})->where() == core::Reorder::Where::Calls;
  p.rayTracingInvocationReorderReorderingHint = reorders ? VK_RAY_TRACING_INVOCATION_REORDER_MODE_REORDER_NV
                                                         : VK_RAY_TRACING_INVOCATION_REORDER_MODE_NONE_NV;
}

}  // namespace

VkPhysicalDeviceLimits limits_of(const pipeline::GpuParams& gpu, bool is_universal) {
  VkPhysicalDeviceLimits l{};
  set_image_limits(l);
  set_descriptor_limits(l);
  set_memory_limits(l);
  set_graphics_limits(l);
  if (is_universal) set_universal_limits(l);
  l.maxComputeSharedMemorySize = gpu.core.shared_bytes;
  l.maxComputeWorkGroupInvocations = exec::kMaxBlockThreads;
  std::fill_n(l.maxComputeWorkGroupCount, 3, kMaxGroups);
  std::fill_n(l.maxComputeWorkGroupSize, 3, exec::kMaxBlockThreads);
  l.timestampComputeAndGraphics = VK_TRUE;
  l.timestampPeriod = float(1000.0 / gpu.clock_mhz);  // nanoseconds of a core cycle
  return l;
}

DeviceProperties properties_of(const pipeline::GpuParams& gpu, const std::string& preset, bool is_universal) {
  DeviceProperties p{};
  // Nobody has certified the device, but wgpu hides devices that say so.
  if (is_universal) p.conformanceVersion = {1, 3, 0, 0};
  set_text(p.driverName, "Glint");
  set_text(p.driverInfo, fmt::format("preset {}, functional", preset));
  set_text(reinterpret_cast<char(&)[VK_UUID_SIZE]>(p.deviceUUID), preset);
  set_text(reinterpret_cast<char(&)[VK_UUID_SIZE]>(p.driverUUID), "glint");
  set_subgroups(p);
  set_floats(p);
  set_descriptor_indexing(p);
  set_inline_uniform_blocks(p);
  set_descriptor_buffers(p);
  set_acceleration_structures(p);
  set_ray_pipelines(p, gpu);
  p.shaderSMCount = gpu.cores, p.shaderWarpsPerSM = gpu.core.warps;
  p.pointClippingBehavior = VK_POINT_CLIPPING_BEHAVIOR_ALL_CLIP_PLANES;
  p.maxMultiviewViewCount = 6, p.maxMultiviewInstanceIndex = (1u << 27) - 1;
  p.maxMemoryAllocationSize = p.maxBufferSize = kMaxAllocationBytes;
  p.supportedDepthResolveModes = p.supportedStencilResolveModes = VK_RESOLVE_MODE_SAMPLE_ZERO_BIT;
  p.framebufferIntegerColorSampleCounts = VK_SAMPLE_COUNT_1_BIT;
  p.maxTimelineSemaphoreValueDifference = (uint64_t{1} << 63) - 1;
  p.storageTexelBufferOffsetAlignmentBytes = p.uniformTexelBufferOffsetAlignmentBytes = 16;
  p.storageTexelBufferOffsetSingleTexelAlignment = p.uniformTexelBufferOffsetSingleTexelAlignment = VK_TRUE;
  // Windows end where ranges end, to the byte.
  p.robustStorageBufferAccessSizeAlignment = p.robustUniformBufferAccessSizeAlignment = 1;
  p.minImportedHostPointerAlignment = kHostPointerAlignment;
  p.maxCustomBorderColorSamplers = kManyDescriptors;
  p.filterMinmaxSingleComponentFormats = p.filterMinmaxImageComponentMapping = VK_TRUE;
  return p;
}

}  // namespace glint::vulkan

VkPhysicalDevice_T::VkPhysicalDevice_T(VkInstance_T& of)
    : instance(of),
      gpu(of.settings.gpu),
      properties(glint::vulkan::properties_of(gpu, of.settings.preset, of.settings.is_universal)) {
  core.apiVersion = VK_MAKE_API_VERSION(0, 1, 3, VK_HEADER_VERSION);
  core.driverVersion = VK_MAKE_API_VERSION(0, 0, 1, 0);
  // Choice: 0 is nobody's number, so no client tunes itself for another vendor's GPU.
  core.vendorID = core.deviceID = 0;
  core.deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
  glint::vulkan::set_text(core.deviceName, fmt::format("Glint {} (simulated)", of.settings.preset));
  glint::vulkan::set_text(reinterpret_cast<char(&)[VK_UUID_SIZE]>(core.pipelineCacheUUID), "glint");
  core.limits = glint::vulkan::limits_of(gpu, instance.settings.is_universal);
}
