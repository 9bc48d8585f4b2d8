// Owns what one frame needs on a device: structures, descriptors, the pipeline, and the binding table.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "device.h"
#include "frame.h"

namespace rt_frames {

// Holds functions of extensions, which have no symbol in the loader.
struct Functions {
  explicit Functions(const Device& device);
  PFN_vkCreateAccelerationStructureKHR create_structure;
  PFN_vkDestroyAccelerationStructureKHR destroy_structure;
  PFN_vkGetAccelerationStructureBuildSizesKHR build_sizes;
  PFN_vkGetAccelerationStructureDeviceAddressKHR address_of;
  PFN_vkCmdBuildAccelerationStructuresKHR build;
  PFN_vkCreateRayTracingPipelinesKHR create_pipelines;
  PFN_vkGetRayTracingShaderGroupHandlesKHR handles;
  PFN_vkCmdTraceRaysKHR trace;
};

struct Structure {
  VkAccelerationStructureKHR handle = nullptr;
  VkDeviceAddress address = 0;
};

class Drawing {
 public:
  Drawing(Device& device, const Frame& frame);

  // Traces the frame once. Returns the nanoseconds between the timestamps before and after the launch.
  double trace();
  // Returns the picture as the text of a PFM file: three floats a pixel, the bottom row first.
  std::string picture();
  uint64_t structure_bytes() const { return structure_bytes_; }

 private:
  struct Order;  // of one structure
  void build_structures();
  std::vector<Structure> build(std::vector<Order>& orders, VkAccelerationStructureTypeKHR type);
  void build_top(const std::vector<Structure>& bottoms);
  void make_descriptors();
  Image texture(const Picture& picture);
  VkSampler sampler(bool repeats);
  void write_descriptors();
  void make_pipeline();
  void make_table();
  const Buffer& buffer(const std::string& name) const { return buffers_.at(name); }

  Device& device_;
  const Frame& frame_;
  Functions call_;
  std::map<std::string, Buffer> buffers_;
  Structure top_;
  uint64_t structure_bytes_ = 0;
  std::map<uint32_t, std::vector<Image>> images_;  // by binding
  std::map<bool, VkSampler> samplers_;             // by whether they repeat
  VkDescriptorSetLayout set_layout_ = nullptr;
  VkDescriptorSet set_ = nullptr;
  VkPipelineLayout layout_ = nullptr;
  VkPipeline pipeline_ = nullptr;
  VkStridedDeviceAddressRegionKHR raygen_{}, miss_{}, hit_{}, callable_{};
  std::string push_constants_;
  VkQueryPool queries_ = nullptr;
};

}  // namespace rt_frames
