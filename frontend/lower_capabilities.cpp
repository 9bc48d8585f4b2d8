// The capabilities that modules may ask for.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "frontend/lower.h"

namespace glint::frontend {
namespace {

using enum spv::Capability;
constexpr spv::Capability kKnown[] = {
    Shader, Matrix, Int64, Int16, Int8, Float16, Float64, GroupNonUniform, GroupNonUniformVote, GroupNonUniformArithmetic,
    GroupNonUniformBallot, GroupNonUniformShuffle, GroupNonUniformShuffleRelative, GroupNonUniformClustered,
    GroupNonUniformQuad, GroupNonUniformPartitionedNV, GroupNonUniformRotateKHR, SubgroupBallotKHR, SubgroupVoteKHR,
    StorageBuffer16BitAccess, UniformAndStorageBuffer16BitAccess, StoragePushConstant16, StorageInputOutput16,
    StorageBuffer8BitAccess, UniformAndStorageBuffer8BitAccess, StoragePushConstant8,
    WorkgroupMemoryExplicitLayoutKHR, WorkgroupMemoryExplicitLayout8BitAccessKHR,
    WorkgroupMemoryExplicitLayout16BitAccessKHR,
    RayTracingKHR, RayTracingProvisionalKHR, RayTracingNV, RayQueryKHR, RayTraversalPrimitiveCullingKHR, RayCullMaskKHR,
    RayTracingMotionBlurNV, ShaderInvocationReorderNV, RayTracingOpacityMicromapEXT, ShaderClockKHR, ShaderSMBuiltinsNV, DeviceGroup,
    RuntimeDescriptorArray, ShaderNonUniform, SampledImageArrayNonUniformIndexing, StorageImageArrayNonUniformIndexing,
    StorageBufferArrayNonUniformIndexing, UniformBufferArrayNonUniformIndexing, UniformTexelBufferArrayNonUniformIndexing,
    StorageTexelBufferArrayNonUniformIndexing, InputAttachmentArrayNonUniformIndexing,
    UniformTexelBufferArrayDynamicIndexing, StorageTexelBufferArrayDynamicIndexing,
    SampledImageArrayDynamicIndexing, StorageImageArrayDynamicIndexing, StorageBufferArrayDynamicIndexing,
    UniformBufferArrayDynamicIndexing, StorageImageReadWithoutFormat, StorageImageWriteWithoutFormat,
    StorageImageExtendedFormats, StorageImageMultisample, ImageQuery, Sampled1D, Image1D, SampledBuffer, ImageBuffer,
    SampledCubeArray, ImageCubeArray, ImageMSArray, ImageGatherExtended, MinLod, Int64ImageEXT, SampledRect, ImageRect,
    PhysicalStorageBufferAddresses, VariablePointers, VariablePointersStorageBuffer, VulkanMemoryModel,
    VulkanMemoryModelDeviceScope, Int64Atomics, AtomicFloat16AddEXT, AtomicFloat32AddEXT, AtomicFloat64AddEXT,
    AtomicFloat16MinMaxEXT, AtomicFloat32MinMaxEXT, AtomicFloat64MinMaxEXT, DotProduct, DotProductInputAll,
    DotProductInput4x8Bit, DotProductInput4x8BitPacked, ExpectAssumeKHR, DenormPreserve, SignedZeroInfNanPreserve,
    RoundingModeRTE, BitInstructions, Groups, DerivativeControl,
    ComputeDerivativeGroupQuadsNV, ComputeDerivativeGroupLinearNV};

}  // namespace

bool is_known_capability(spv::Capability capability) {
  return std::find(std::begin(kKnown), std::end(kKnown), capability) != std::end(kKnown);
}

}  // namespace glint::frontend
