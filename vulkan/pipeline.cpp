// Makes shader modules, pipeline layouts, pipeline caches and compute pipelines, and compiles pipelines.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/pipeline.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <fmt/format.h>
#include <utility>

#include "frontend/spirv/known_words.h"
#include "isa/program.h"
#include "isa/stage.h"
#include "pipeline/software_traversal.h"
#include "vulkan/chain.h"
#include "vulkan/device.h"

namespace glint::vulkan {
namespace {

std::shared_ptr<const std::vector<uint32_t>> words_of(const VkShaderModuleCreateInfo& info) {
  if (info.codeSize % sizeof(uint32_t) || info.codeSize < 5 * sizeof(uint32_t))
    throw Refusal(fmt::format("{} bytes are not a SPIR-V module", info.codeSize));
  std::vector<uint32_t> words(info.pCode, info.pCode + info.codeSize / sizeof(uint32_t));
  return std::make_shared<const std::vector<uint32_t>>(frontend::with_known_words(std::move(words)));
}

std::map<uint32_t, uint64_t> constants_of(const VkSpecializationInfo* info) {
  std::map<uint32_t, uint64_t> out;
  for (uint32_t i = 0; info && i < info->mapEntryCount; ++i) {
    const VkSpecializationMapEntry& entry = info->pMapEntries[i];
    uint64_t value = 0;
    if (entry.size > sizeof value || entry.offset + entry.size > info->dataSize)
      throw Refusal(fmt::format("specialisation constant {} lies outside of its data", entry.constantID));
    std::memcpy(&value, static_cast<const std::byte*>(info->pData) + entry.offset, entry.size);
    out[entry.constantID] = value;
  }
  return out;
}

std::unique_ptr<VkPipeline_T> pipeline_of(Device& device, const VkComputePipelineCreateInfo& info) {
  auto made = std::make_unique<VkPipeline_T>();
  made->stages.push_back(stage_of(device, info.stage));
  made->name = made->stages[0].name;
  made->layout = *info.layout;
  return made;
}

}  // namespace

VkShaderStageFlagBits flag_of(isa::Stage stage) {
  switch (stage) {
    case isa::Stage::RayGeneration:
      return VK_SHADER_STAGE_RAYGEN_BIT_KHR;
    case isa::Stage::Miss:
      return VK_SHADER_STAGE_MISS_BIT_KHR;
    case isa::Stage::ClosestHit:
      return VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR;
    case isa::Stage::AnyHit:
      return VK_SHADER_STAGE_ANY_HIT_BIT_KHR;
    case isa::Stage::Intersection:
      return VK_SHADER_STAGE_INTERSECTION_BIT_KHR;
    case isa::Stage::Callable:
      return VK_SHADER_STAGE_CALLABLE_BIT_KHR;
    case isa::Stage::Compute:
      break;
  }
  return VK_SHADER_STAGE_COMPUTE_BIT;
}

PipelineStage stage_of(Device& device, const VkPipelineShaderStageCreateInfo& info) {
  PipelineStage out;
  out.stage = info.stage;
  if (info.module) {
    out.words = info.module->words, out.name = info.module->name;
  } else if (const auto* module = find_in_chain<VkShaderModuleCreateInfo>(
                 &info, VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO)) {
    out.words = words_of(*module), out.name = fmt::format("shader {}", ++device.shaders_made);
  } else {
    throw Refusal("a pipeline needs a shader module");
  }
  const auto* subgroups = find_in_chain<VkPipelineShaderStageRequiredSubgroupSizeCreateInfo>(
      &info, VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO);
  if (subgroups && subgroups->requiredSubgroupSize != uint32_t(kLanes))
    throw Refusal(fmt::format("a stage asks for subgroups of {} threads, and the device's have {}",
                              subgroups->requiredSubgroupSize, kLanes));
  out.entry_point = info.pName;
  out.constants = constants_of(info.pSpecializationInfo);
  return out;
}

VkResult CreateShaderModule(Device& device, const VkShaderModuleCreateInfo* info, VkShaderModule* out) {
  *out = new VkShaderModule_T{words_of(*info), fmt::format("shader {}", ++device.shaders_made)};
  return VK_SUCCESS;
}
void DestroyShaderModule(Device&, VkShaderModule module) {
  delete module;
}

VkResult CreatePipelineLayout(Device&, const VkPipelineLayoutCreateInfo* info, VkPipelineLayout* out) {
  if (info->setLayoutCount > isa::kMaxSets)
    throw Refusal(fmt::format("{} sets are more than {}", info->setLayoutCount, isa::kMaxSets));
  auto made = std::make_unique<VkPipelineLayout_T>();
  for (uint32_t i = 0; i < info->setLayoutCount; ++i)
    made->sets.push_back(info->pSetLayouts[i] ? *info->pSetLayouts[i] : DescriptorSetLayout{});
  *out = made.release();
  return VK_SUCCESS;
}
void DestroyPipelineLayout(Device&, VkPipelineLayout layout) {
  delete layout;
}

VkResult CreateComputePipelines(Device& device, VkPipelineCache, uint32_t count,
                                const VkComputePipelineCreateInfo* infos, VkPipeline* out) {
  std::fill_n(out, count, VkPipeline{});
  for (uint32_t i = 0; i < count; ++i)
    answer_feedback(infos[i]), out[i] = pipeline_of(device, infos[i]).release();
  return VK_SUCCESS;
}
void DestroyPipeline(Device&, VkPipeline pipeline) {
  delete pipeline;
}

// Choice: pipelines are compiled when they run, and the driver keeps what it compiled itself. So an
// application's cache holds nothing but the header that Vulkan asks for.
VkResult CreatePipelineCache(Device&, const VkPipelineCacheCreateInfo*, VkPipelineCache* out) {
  *out = new VkPipelineCache_T;
  return VK_SUCCESS;
}
void DestroyPipelineCache(Device&, VkPipelineCache cache) {
  delete cache;
}
VkResult MergePipelineCaches(Device&, VkPipelineCache, uint32_t, const VkPipelineCache*) {
  return VK_SUCCESS;
}
VkResult GetPipelineCacheData(Device& device, VkPipelineCache, size_t* bytes, void* out) {
  VkPipelineCacheHeaderVersionOne header{sizeof header,
                                         VK_PIPELINE_CACHE_HEADER_VERSION_ONE,
                                         device.physical.core.vendorID,
                                         device.physical.core.deviceID,
                                         {}};
  std::copy_n(device.physical.core.pipelineCacheUUID, VK_UUID_SIZE, header.pipelineCacheUUID);
  const bool fits = out && *bytes >= sizeof header;
  if (fits) std::memcpy(out, &header, sizeof header);
  *bytes = out && !fits ? 0 : sizeof header;
  return out && !fits ? VK_INCOMPLETE : VK_SUCCESS;
}

}  // namespace glint::vulkan

const glint::pipeline::LinkedShaders& VkPipeline_T::compiled(VkDevice_T& device) {
  using namespace glint;
  if (compiled_) return *compiled_;
  const pipeline::GpuParams& gpu = device.physical.gpu;
  const pipeline::CompilerParams compiler = pipeline::compiler_for(gpu);
  std::vector<isa::Program> programs;
  std::vector<frontend::Binding> bindings;
  Diagnostics notes;
  for (const vulkan::PipelineStage& each : stages) binding_numbers_.note(*each.words);
  for (const auto& [place, number] : binding_numbers_.changes())
    device.messages().info(fmt::format("{}: messages call binding {} of set {} by the number {}", name,
                                       place.second, place.first, number));
  for (const vulkan::PipelineStage& each : stages) {
    // Choice: the driver validates modules, although Vulkan leaves that to a layer, because an invalid one
    // would end the process.
    pipeline::CompiledStage made =
        pipeline::compile_stage(binding_numbers_.changed(*each.words),
                                {each.name, each.entry_point, each.constants, frontend::Validity::Unknown},
                                compiler, notes, &device.shader_cache);
    if (vulkan::flag_of(made.program.stage) != each.stage)
      throw UserError(fmt::format("entry point '{}' of {} is of stage {}, and the pipeline wants another",
                                  each.entry_point, each.name, isa::name_of(made.program.stage)));
    programs.push_back(std::move(made.program));
    bindings.insert(bindings.end(), made.reflection.bindings.begin(), made.reflection.bindings.end());
  }
  for (const std::string& note : notes.messages()) device.messages().warning(note);
  compiled_ = std::make_unique<const pipeline::LinkedShaders>(std::move(programs), bindings, gpu,
                                                              &device.shader_cache);
  return *compiled_;
}
