// Holds shader modules, pipeline layouts and pipelines, which are compiled when they first run.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/binding_table.h"
#include "pipeline/linked_shaders.h"
#include "vulkan/binding_numbers.h"
#include "vulkan/chain.h"
#include "vulkan/descriptor_set.h"

struct VkShaderModule_T {
  std::shared_ptr<const std::vector<uint32_t>> words;
  std::string name;
};

struct VkPipelineLayout_T {
  std::vector<VkDescriptorSetLayout_T> sets;  // copies: the application may destroy its own
};

struct VkPipelineCache_T {};

namespace glint::vulkan {

struct PipelineStage {
  VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT;
  std::shared_ptr<const std::vector<uint32_t>> words;
  std::string entry_point, name;
  std::map<uint32_t, uint64_t> constants;  // by constant_id
};
// Returns what Vulkan calls the stage.
VkShaderStageFlagBits flag_of(isa::Stage stage);

// Says in the feedback that an application asked for with `info` that nothing is known: pipelines are
// compiled when they run.
template <class Info>
void answer_feedback(const Info& info) {
  const auto* asked = find_in_chain<VkPipelineCreationFeedbackCreateInfo>(
      &info, VK_STRUCTURE_TYPE_PIPELINE_CREATION_FEEDBACK_CREATE_INFO);
  if (!asked) return;
  *asked->pPipelineCreationFeedback = {};
  std::fill_n(asked->pPipelineStageCreationFeedbacks, asked->pipelineStageCreationFeedbackCount,
              VkPipelineCreationFeedback{});
}

// Throws Refusal for a stage without a module.
PipelineStage stage_of(Device& device, const VkPipelineShaderStageCreateInfo& info);

// Is what a ray-tracing pipeline has besides its stages.
struct RayGroups {
  uint64_t pipeline = 0;                      // the number that the handles of the groups hold
  std::vector<pipeline::ShaderGroup> groups;  // with numbers of stages
  uint32_t max_trace_depth = 0;
  uint32_t added_ray_flags = 0;  // of each trace: exec::World::added_ray_flags
  bool has_dynamic_stack = false;
  bool has_said_depth = false;  // that traces are nested deeper than the application said
};

}  // namespace glint::vulkan

// Is a compute pipeline, a ray-tracing pipeline or a library of one. Applications make hundreds that they
// never run, so it is compiled when it first runs.
struct VkPipeline_T {
  std::string name;
  std::vector<glint::vulkan::PipelineStage> stages;  // of a compute pipeline: one
  std::optional<glint::vulkan::RayGroups> rays;      // nothing: a compute pipeline
  VkPipelineLayout_T layout;
  uint64_t launches = 0;  // so far

  // Returns the compiled shaders, in the order of the stages. Throws UserError or UnsupportedError when one
  // cannot be compiled.
  const glint::pipeline::LinkedShaders& compiled(VkDevice_T& device);
  // Says which of the application's bindings the compiled shaders know by a number of their own.
  const glint::vulkan::BindingNumbers& binding_numbers() const { return binding_numbers_; }

 private:
  std::unique_ptr<const glint::pipeline::LinkedShaders> compiled_;
  glint::vulkan::BindingNumbers binding_numbers_;
};
