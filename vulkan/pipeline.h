// Holds shader modules, pipeline layouts and compute pipelines, which are compiled when they first run.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/linked_shaders.h"
#include "vulkan/descriptor_set.h"

struct VkShaderModule_T {
  std::shared_ptr<const std::vector<uint32_t>> words;
  std::string name;
};

struct VkPipelineLayout_T {
  std::vector<VkDescriptorSetLayout_T> sets;  // copies: the application may destroy its own
};

struct VkPipelineCache_T {};

// Is a compute pipeline. Applications make hundreds that they never run, so it is compiled when it first
// runs.
struct VkPipeline_T {
  std::shared_ptr<const std::vector<uint32_t>> words;
  std::string entry_point, name;
  std::map<uint32_t, uint64_t> constants;  // by constant_id
  VkPipelineLayout_T layout;
  uint64_t launches = 0;  // so far

  // Returns the compiled shader. Throws UserError or UnsupportedError when it cannot be compiled.
  const glint::pipeline::LinkedShaders& compiled(VkDevice_T& device);

 private:
  std::unique_ptr<const glint::pipeline::LinkedShaders> compiled_;
};
