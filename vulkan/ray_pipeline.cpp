// Makes ray-tracing pipelines from stages, groups and libraries, and gives the handles of groups.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/device_table.h"
#include "rtunit/traversal/ray.h"
#include "vulkan/device.h"
#include "vulkan/pipeline.h"

namespace glint::vulkan {
namespace {

constexpr VkShaderStageFlags kGeneral =
    VK_SHADER_STAGE_RAYGEN_BIT_KHR | VK_SHADER_STAGE_MISS_BIT_KHR | VK_SHADER_STAGE_CALLABLE_BIT_KHR;

// Returns the number of a group's shader. Throws Refusal when the pipeline has no such stage.
uint32_t shader_of(const VkPipeline_T& pipeline, uint32_t stage, VkShaderStageFlags wanted,
                   const char* member) {
  if (stage == VK_SHADER_UNUSED_KHR) return exec::kNoShader;
  if (stage >= pipeline.stages.size() || !(pipeline.stages[stage].stage & wanted))
    throw Refusal(fmt::format("a group's {} is stage {}, which the pipeline lacks or has for another purpose",
                              member, stage));
  return stage;
}

pipeline::ShaderGroup group_of(const VkPipeline_T& pipeline,
                               const VkRayTracingShaderGroupCreateInfoKHR& from) {
  pipeline::ShaderGroup out;
  if (from.type == VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR) {
    out.general = shader_of(pipeline, from.generalShader, kGeneral, "generalShader");
    if (out.general == exec::kNoShader) throw Refusal("a general group has no shader");
    return out;
  }
  out.hit.closest_hit =
      shader_of(pipeline, from.closestHitShader, VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, "closestHitShader");
  out.hit.any_hit = shader_of(pipeline, from.anyHitShader, VK_SHADER_STAGE_ANY_HIT_BIT_KHR, "anyHitShader");
  if (from.type == VK_RAY_TRACING_SHADER_GROUP_TYPE_PROCEDURAL_HIT_GROUP_KHR)
    out.hit.intersection = shader_of(pipeline, from.intersectionShader, VK_SHADER_STAGE_INTERSECTION_BIT_KHR,
                                     "intersectionShader");
  return out;
}

// Appends the stages of a library. Returns the number of the first one.
uint32_t append_stages(VkPipeline_T& to, const VkPipeline_T& library) {
  if (!library.rays) throw Refusal("a library is not a ray-tracing pipeline");
  const auto first = uint32_t(to.stages.size());
  to.stages.insert(to.stages.end(), library.stages.begin(), library.stages.end());
  return first;
}

// Appends the groups of a library, whose stages begin with number `first`.
void append_groups(VkPipeline_T& to, const VkPipeline_T& library, uint32_t first) {
  const auto moved = [first](uint32_t shader) { return shader == exec::kNoShader ? shader : shader + first; };
  for (pipeline::ShaderGroup group : library.rays->groups) {
    group.general = moved(group.general);
    group.hit = {moved(group.hit.closest_hit), moved(group.hit.any_hit), moved(group.hit.intersection)};
    to.rays->groups.push_back(group);
  }
}

// A pipeline has the name of its first ray generation shader.
std::string name_of(const VkPipeline_T& pipeline) {
  for (const PipelineStage& each : pipeline.stages)
    if (each.stage == VK_SHADER_STAGE_RAYGEN_BIT_KHR) return each.name;
  return "pipeline library";
}

std::unique_ptr<VkPipeline_T> pipeline_of(Device& device, const VkRayTracingPipelineCreateInfoKHR& info) {
  auto made = std::make_unique<VkPipeline_T>();
  for (uint32_t i = 0; i < info.stageCount; ++i) made->stages.push_back(stage_of(device, info.pStages[i]));
  RayGroups& rays = made->rays.emplace();
  rays.pipeline = ++device.ray_pipelines_made;
  if (info.maxPipelineRayRecursionDepth > kMaxRayRecursion)
    throw Refusal(fmt::format("traces may be nested {} deep, and a pipeline asks for {}", kMaxRayRecursion,
                              info.maxPipelineRayRecursionDepth));
  rays.max_trace_depth = info.maxPipelineRayRecursionDepth;
  if (info.flags & VK_PIPELINE_CREATE_RAY_TRACING_SKIP_TRIANGLES_BIT_KHR)
    rays.added_ray_flags |= rt::ray_flag::kSkipTriangles;
  if (info.flags & VK_PIPELINE_CREATE_RAY_TRACING_SKIP_AABBS_BIT_KHR)
    rays.added_ray_flags |= rt::ray_flag::kSkipAabbs;
  for (uint32_t i = 0; info.pDynamicState && i < info.pDynamicState->dynamicStateCount; ++i)
    rays.has_dynamic_stack |=
        info.pDynamicState->pDynamicStates[i] == VK_DYNAMIC_STATE_RAY_TRACING_PIPELINE_STACK_SIZE_KHR;
  // The pipeline's own groups may name stages of its libraries, which are numbered after its own.
  std::vector<uint32_t> first_stages;
  const uint32_t num_libraries = info.pLibraryInfo ? info.pLibraryInfo->libraryCount : 0;
  for (uint32_t i = 0; i < num_libraries; ++i)
    first_stages.push_back(append_stages(*made, *info.pLibraryInfo->pLibraries[i]));
  for (uint32_t i = 0; i < info.groupCount; ++i) rays.groups.push_back(group_of(*made, info.pGroups[i]));
  for (uint32_t i = 0; i < num_libraries; ++i)
    append_groups(*made, *info.pLibraryInfo->pLibraries[i], first_stages[i]);
  if (info.layout) made->layout = *info.layout;
  made->name = name_of(*made);
  return made;
}

const RayGroups& groups_of(VkPipeline pipeline, uint32_t first, uint32_t count) {
  if (!pipeline->rays) throw Refusal("a compute pipeline has no shader groups");
  const size_t there = pipeline->rays->groups.size();
  if (first > there || count > there - first)
    throw Refusal(fmt::format("groups {} to {} are not in a pipeline of {}", first, first + count, there));
  return *pipeline->rays;
}

}  // namespace

// Choice: deferred creations are done at once.
VkResult CreateRayTracingPipelinesKHR(Device& device, VkDeferredOperationKHR operation, VkPipelineCache,
                                      uint32_t count, const VkRayTracingPipelineCreateInfoKHR* infos,
                                      VkPipeline* out) {
  std::fill_n(out, count, VkPipeline{});
  for (uint32_t i = 0; i < count; ++i)
    answer_feedback(infos[i]), out[i] = pipeline_of(device, infos[i]).release();
  return operation ? VK_OPERATION_NOT_DEFERRED_KHR : VK_SUCCESS;
}

VkResult GetRayTracingShaderGroupHandlesKHR(Device&, VkPipeline pipeline, uint32_t first, uint32_t count,
                                            size_t bytes, void* out) {
  const RayGroups& rays = groups_of(pipeline, first, count);
  if (bytes < size_t(count) * exec::kHandleBytes)
    throw Refusal(fmt::format("{} handles do not fit into {} bytes", count, bytes));
  for (uint32_t i = 0; i < count; ++i) {
    const pipeline::GroupHandle handle = pipeline::group_handle(rays.pipeline, first + i);
    std::memcpy(static_cast<std::byte*>(out) + size_t(i) * handle.size(), handle.data(), handle.size());
  }
  return VK_SUCCESS;
}

VkResult GetRayTracingCaptureReplayShaderGroupHandlesKHR(Device&, VkPipeline, uint32_t, uint32_t, size_t,
                                                         void*) {
  throw Refusal(VK_ERROR_FEATURE_NOT_PRESENT, "handles of groups cannot be given to another pipeline");
}

VkDeviceSize GetRayTracingShaderGroupStackSizeKHR(Device& device, VkPipeline pipeline, uint32_t group,
                                                  VkShaderGroupShaderKHR which) {
  const pipeline::ShaderGroup& of = groups_of(pipeline, group, 1).groups[group];
  uint32_t shader = of.general;
  if (which == VK_SHADER_GROUP_SHADER_CLOSEST_HIT_KHR) shader = of.hit.closest_hit;
  if (which == VK_SHADER_GROUP_SHADER_ANY_HIT_KHR) shader = of.hit.any_hit;
  if (which == VK_SHADER_GROUP_SHADER_INTERSECTION_KHR) shader = of.hit.intersection;
  if (shader == exec::kNoShader) return 0;
  return pipeline->compiled(device).image().shaders.at(shader).local_bytes;
}

}  // namespace glint::vulkan
