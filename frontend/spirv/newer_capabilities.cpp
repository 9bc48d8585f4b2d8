// Holds the names of capabilities by number.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/newer_capabilities.h"

#include <algorithm>
#include <iterator>

namespace glint::frontend {
namespace {

struct Row {
  uint32_t number;
  std::string_view name;
};

// The rows are in the order of the numbers.
constexpr Row kRows[] = {
    {4166, "TileImageColorReadAccessEXT"},
    {4167, "TileImageDepthReadAccessEXT"},
    {4168, "TileImageStencilReadAccessEXT"},
    {4174, "TensorsARM"},
    {4175, "StorageTensorArrayDynamicIndexingARM"},
    {4176, "StorageTensorArrayNonUniformIndexingARM"},
    {4191, "GraphARM"},
    {4201, "CooperativeMatrixLayoutsARM"},
    {4212, "Float8EXT"},
    {4213, "Float8CooperativeMatrixEXT"},
    {4228, "Float6EXT"},
    {4229, "Float4EXT"},
    {4230, "Float8UnsignedE8M0EXT"},
    {4231, "MXInt8EXT"},
    {4232, "BitcastExtractEXT"},
    {4473, "UntypedPointersKHR"},
    {4484, "TextureSampleWeightedQCOM"},
    {4485, "TextureBoxFilterQCOM"},
    {4486, "TextureBlockMatchQCOM"},
    {4495, "TileShadingQCOM"},
    {4496, "CooperativeMatrixConversionQCOM"},
    {4498, "TextureBlockMatch2QCOM"},
    {4539, "MultipleWaitQueuesQCOM"},
    {4543, "ImageGatherLinearQCOM"},
    {4544, "ImageGatherExtendedModesQCOM"},
    {5067, "ShaderEnqueueAMDX"},
    {5087, "QuadControlKHR"},
    {5112, "Int4TypeINTEL"},
    {5114, "Int4CooperativeMatrixINTEL"},
    {5116, "BFloat16TypeKHR"},
    {5117, "BFloat16DotProductKHR"},
    {5118, "BFloat16CooperativeMatrixKHR"},
    {5120, "AbortKHR"},
    {5128, "DescriptorHeapEXT"},
    {5146, "ConstantDataKHR"},
    {5156, "PoisonFreezeKHR"},
    {5181, "WeakLinkageAMD"},
    {5336, "RayTracingPositionFetchKHR"},
    {5380, "DisplacementMicromapNV"},
    {5388, "ShaderInvocationReorderEXT"},
    {5391, "RayQueryPositionFetchKHR"},
    {5394, "CooperativeVectorNV"},
    {5404, "AtomicFloat16VectorNV"},
    {5409, "RayTracingDisplacementMicromapNV"},
    {5414, "RawAccessChainsNV"},
    {5418, "RayTracingSpheresGeometryNV"},
    {5419, "RayTracingLinearSweptSpheresGeometryNV"},
    {5423, "PushConstantBanksNV"},
    {5425, "LongVectorEXT"},
    {5426, "Shader64BitIndexingEXT"},
    {5429, "CooperativeMatrixConversionsEXT"},
    {5430, "CooperativeMatrixReductionsEXT"},
    {5431, "CooperativeMatrixConversionsNV"},
    {5432, "CooperativeMatrixPerElementOperationsEXT"},
    {5433, "CooperativeMatrixTensorAddressingNV"},
    {5434, "CooperativeMatrixBlockLoadsNV"},
    {5435, "CooperativeVectorTrainingNV"},
    {5437, "RayTracingClusterAccelerationStructureNV"},
    {5438, "CooperativeMatrixGetCoordinateEXT"},
    {5439, "TensorAddressingNV"},
    {5447, "CooperativeMatrixDecodeVectorNV"},
    {6022, "CooperativeMatrixKHR"},
    {6024, "ReplicatedCompositesEXT"},
    {6029, "FloatControls2"},
    {6030, "FMAKHR"},
    {6032, "RayTracingOpacityMicromapExecutionModeKHR"},
    {6115, "BFloat16ConversionINTEL"},
    {6144, "ArithmeticFenceEXT"},
    {6150, "FPGAClusterAttributesV2ALTERA"},
    {6161, "FPGAKernelAttributesv2INTEL"},
    {6162, "TaskSequenceALTERA"},
    {6169, "FPMaxErrorINTEL"},
    {6171, "FPGALatencyControlALTERA"},
    {6174, "FPGAArgumentInterfacesALTERA"},
    {6187, "GlobalVariableHostAccessINTEL"},
    {6189, "GlobalVariableFPGADecorationsALTERA"},
    {6220, "SubgroupBufferPrefetchINTEL"},
    {6228, "Subgroup2DBlockIOINTEL"},
    {6229, "Subgroup2DBlockTransformINTEL"},
    {6230, "Subgroup2DBlockTransposeINTEL"},
    {6236, "SubgroupMatrixMultiplyAccumulateINTEL"},
    {6241, "TernaryBitwiseFunctionINTEL"},
    {6243, "UntypedVariableLengthArrayINTEL"},
    {6245, "SpecConditionalINTEL"},
    {6246, "FunctionVariantsINTEL"},
    {6257, "PredicatedIOINTEL"},
    {6265, "RoundedDivideSqrtINTEL"},
    {6425, "TensorFloat32RoundingINTEL"},
    {6427, "MaskedGatherScatterINTEL"},
    {6441, "CacheControlsINTEL"},
    {6460, "RegisterLimitsINTEL"},
    {6528, "BindlessImagesINTEL"},
    {6912, "DotProductFloat16AccFloat32VALVE"},
    {6913, "DotProductFloat16AccFloat16VALVE"},
    {6914, "DotProductBFloat16AccVALVE"},
    {6915, "DotProductFloat8AccFloat32VALVE"},
    {7041, "IntrinsicSAMSUNG"},
};

}  // namespace

std::string_view newer_capability(uint32_t capability) {
  const Row* row = std::lower_bound(std::begin(kRows), std::end(kRows), capability,
                                    [](const Row& a, uint32_t number) { return a.number < number; });
  return row != std::end(kRows) && row->number == capability ? row->name : std::string_view();
}

}  // namespace glint::frontend
