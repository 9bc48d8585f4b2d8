// SHADER, VIRTUAL_FILE, and what a script asks of the device.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "amber/parse.h"

namespace glint::amber {
namespace {

// What the simulated GPU offers, by the names of Vulkan's structures. Graphics features are in the list because
// scripts ask for them without need: a graphics pipeline is refused by itself.
const std::set<std::string>& known_features() {
  static const std::set<std::string> names{
      "robustBufferAccess", "shaderFloat64", "shaderInt64", "shaderInt16", "shaderStorageImageExtendedFormats", "shaderStorageImageReadWithoutFormat",
      "shaderStorageImageWriteWithoutFormat", "shaderUniformBufferArrayDynamicIndexing", "shaderSampledImageArrayDynamicIndexing",
      "shaderStorageBufferArrayDynamicIndexing", "shaderStorageImageArrayDynamicIndexing", "shaderImageGatherExtended", "imageCubeArray",
      "vertexPipelineStoresAndAtomics", "fragmentStoresAndAtomics", "samplerAnisotropy", "fullDrawIndexUint32", "independentBlend",
      "VariablePointerFeatures.variablePointers", "VariablePointerFeatures.variablePointersStorageBuffer",
      "VariablePointersFeatures.variablePointers", "VariablePointersFeatures.variablePointersStorageBuffer",
      "Float16Int8Features.shaderFloat16", "Float16Int8Features.shaderInt8",
      "Storage8BitFeatures.storageBuffer8BitAccess", "Storage8BitFeatures.uniformAndStorageBuffer8BitAccess", "Storage8BitFeatures.storagePushConstant8",
      "Storage16BitFeatures.storageBuffer16BitAccess", "Storage16BitFeatures.uniformAndStorageBuffer16BitAccess", "Storage16BitFeatures.storagePushConstant16",
      "Shader8BitStorageFeatures.storageBuffer8BitAccess", "Shader16BitStorageFeatures.storageBuffer16BitAccess",
      "SubgroupSizeControl.subgroupSizeControl", "SubgroupSizeControl.computeFullSubgroups",
      "SubgroupSupportedOperations.basic", "SubgroupSupportedOperations.vote", "SubgroupSupportedOperations.arithmetic", "SubgroupSupportedOperations.ballot",
      "SubgroupSupportedOperations.shuffle", "SubgroupSupportedOperations.shuffleRelative", "SubgroupSupportedOperations.shuffle_relative",
      "SubgroupSupportedOperations.clustered", "SubgroupSupportedOperations.quad", "SubgroupSupportedOperations.rotate",
      "SubgroupSupportedOperations.rotateClustered", "SubgroupSupportedStages.compute",
      "ShaderSubgroupExtendedTypesFeatures.shaderSubgroupExtendedTypes", "ScalarBlockLayoutFeatures.scalarBlockLayout",
      "UniformBufferStandardLayoutFeatures.uniformBufferStandardLayout", "DescriptorIndexingFeatures.runtimeDescriptorArray",
      "RayTracingPipelineFeaturesKHR.rayTracingPipeline", "RayQueryFeaturesKHR.rayQuery", "AccelerationStructureFeaturesKHR.accelerationStructure",
      "BufferDeviceAddressFeatures.bufferDeviceAddress", "ZeroInitializeWorkgroupMemoryFeatures.shaderZeroInitializeWorkgroupMemory",
      "ShaderSubgroupUniformControlFlowFeatures.shaderSubgroupUniformControlFlow", "SubgroupUniformControlFlow.shaderSubgroupUniformControlFlow",
      "ShaderIntegerDotProductFeatures.shaderIntegerDotProduct", "WorkgroupMemoryExplicitLayoutFeatures.workgroupMemoryExplicitLayout",
      "VulkanMemoryModelFeatures.vulkanMemoryModel", "VulkanMemoryModelFeatures.vulkanMemoryModelDeviceScope",
      "ShaderAtomicInt64Features.shaderBufferInt64Atomics", "ShaderAtomicInt64Features.shaderSharedInt64Atomics", "ShaderClockFeatures.shaderSubgroupClock",
      "ShaderAtomicFloatFeatures.shaderBufferFloat32Atomics", "ShaderAtomicFloatFeatures.shaderBufferFloat32AtomicAdd", "ShaderExpectAssumeFeatures.shaderExpectAssume",
      "VariablePointers.variablePointers", "VariablePointers.variablePointersStorageBuffer"};
  return names;
}

// Extensions whose shader side Glint has, or that change nothing for shaders.
const std::set<std::string>& known_extensions() {
  static const std::set<std::string> names{
      "VK_KHR_get_physical_device_properties2", "VK_KHR_storage_buffer_storage_class", "VK_KHR_variable_pointers", "VK_KHR_shader_float16_int8",
      "VK_KHR_8bit_storage", "VK_KHR_16bit_storage", "VK_KHR_spirv_1_4", "VK_KHR_shader_float_controls", "VK_KHR_shader_float_controls2",
      "VK_EXT_subgroup_size_control", "VK_KHR_shader_subgroup_extended_types", "VK_KHR_shader_subgroup_uniform_control_flow",
      "VK_KHR_shader_subgroup_rotate", "VK_KHR_shader_maximal_reconvergence", "VK_EXT_scalar_block_layout", "VK_KHR_uniform_buffer_standard_layout",
      "VK_KHR_relaxed_block_layout", "VK_EXT_descriptor_indexing", "VK_KHR_ray_tracing_pipeline", "VK_KHR_ray_query", "VK_KHR_acceleration_structure",
      "VK_KHR_deferred_host_operations", "VK_KHR_buffer_device_address", "VK_KHR_pipeline_library", "VK_KHR_zero_initialize_workgroup_memory",
      "VK_KHR_shader_non_semantic_info", "VK_KHR_shader_terminate_invocation", "VK_KHR_shader_integer_dot_product", "VK_KHR_vulkan_memory_model",
      "VK_KHR_workgroup_memory_explicit_layout", "VK_KHR_maintenance1", "VK_KHR_maintenance2", "VK_KHR_maintenance3", "VK_KHR_maintenance4",
      "VK_KHR_maintenance5", "VK_EXT_shader_subgroup_ballot", "VK_EXT_shader_subgroup_vote", "VK_KHR_shader_expect_assume", "VK_KHR_shader_relaxed_extended_instruction",
      "VK_GOOGLE_decorate_string", "VK_GOOGLE_hlsl_functionality1", "VK_KHR_dedicated_allocation", "VK_KHR_get_memory_requirements2",
      "VK_KHR_bind_memory2", "VK_KHR_external_memory_capabilities", "VK_KHR_external_memory", "VK_KHR_shader_clock", "VK_EXT_shader_atomic_float",
      "VK_EXT_shader_atomic_float2", "VK_KHR_shader_atomic_int64", "VK_KHR_shader_draw_parameters", "VK_KHR_device_group", "VK_EXT_robustness2",
      "VK_KHR_copy_commands2", "VK_KHR_synchronization2", "VK_NV_shader_subgroup_partitioned", "VK_NV_shader_sm_builtins", "VK_EXT_debug_utils"};
  return names;
}

// Float controls: numbers of all sizes keep their denormals, infinities, signs and NaNs and round to nearest even.
bool is_known_property(const std::string& name) {
  const std::string prefix = "FloatControlsProperties.shader";
  if (name.rfind(prefix, 0) != 0) return false;
  const std::string what = name.substr(prefix.size());
  return what.rfind("SignedZeroInfNanPreserveFloat", 0) == 0 || what.rfind("DenormPreserveFloat", 0) == 0 || what.rfind("RoundingModeRTEFloat", 0) == 0;
}

Language language_named(Parsing& p, const std::string& name) {
  if (name == "GLSL") return Language::Glsl;
  if (name == "SPIRV-ASM") return Language::SpirvText;
  if (name == "SPIRV-HEX") return Language::SpirvHex;
  if (name == "SPIRV-BIN") return Language::SpirvBinary;
  if (name == "HLSL" || name == "OPENCL-C" || name == "PASSTHROUGH") p.unsupported("shaders in " + name);
  p.wrong(fmt::format("there is no shader format '{}'", name));
}

}  // namespace

isa::Stage stage_named(Parsing& p, const std::string& name) {
  const std::map<std::string, isa::Stage> stages{{"compute", isa::Stage::Compute}, {"ray_generation", isa::Stage::RayGeneration},
                                                 {"any_hit", isa::Stage::AnyHit}, {"closest_hit", isa::Stage::ClosestHit},
                                                 {"miss", isa::Stage::Miss}, {"intersection", isa::Stage::Intersection},
                                                 {"callable", isa::Stage::Callable}};
  if (const auto found = stages.find(name); found != stages.end()) return found->second;
  for (const char* graphics : {"vertex", "fragment", "geometry", "tessellation_evaluation", "tessellation_control", "mesh", "task"})
    if (name == graphics) p.unsupported(fmt::format("graphics: {} shaders", name));
  p.wrong(fmt::format("there is no shader type '{}'", name));
}

void parse_shader(Parsing& p) {
  Shader shader;
  const std::string type = p.tokens.word("the shader's type");
  if (type != "multi") shader.stage = stage_named(p, type);
  shader.name = p.tokens.word("the shader's name");
  shader.language = language_named(p, p.tokens.word("the shader's format"));
  if (p.tokens.accept("TARGET_ENV")) shader.target_env = p.tokens.word("the target environment");
  shader.path = p.tokens.file();
  const bool is_virtual = p.tokens.peek().is("VIRTUAL_FILE"), is_file = p.tokens.peek().is("FILE");
  if (is_virtual || is_file) {
    p.tokens.next();
    shader.path = p.tokens.word("the file");
    shader.text = p.read_file(shader.path);
  } else {
    int first_line = 1;
    const std::string text = p.tokens.raw_until_end(first_line);
    shader.text = (shader.language == Language::SpirvHex ? "" : std::string(size_t(first_line - 1), '\n')) + text;
  }
  p.declare(p.script.shaders, shader.name, "shader") = shader;
}

void parse_virtual_file(Parsing& p) {
  const std::string name = p.tokens.word("the file's name");
  int first_line = 0;
  p.declare(p.script.virtual_files, name, "virtual file") = p.tokens.raw_until_end(first_line);
}

void parse_device(Parsing& p, const std::string& command) {
  const std::string name = p.tokens.word("a name");
  const bool is_known = command == "DEVICE_FEATURE" ? known_features().count(name) != 0
                        : command == "DEVICE_PROPERTY" ? is_known_property(name) : known_extensions().count(name) != 0;
  if (!is_known) p.unsupported(command + " " + name);
  p.script.features.insert(name);
}

}  // namespace glint::amber
