// Holds a frame as frame.json describes it (docs/frames.md): shaders, buffers, structures, bindings, launch.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>
#include <vulkan/vulkan.h>

namespace rt_frames {

struct Range {
  std::string buffer;
  uint64_t offset = 0, stride = 0, count = 0;
};

struct Shader {
  VkShaderStageFlagBits stage{};
  std::filesystem::path file;
  std::string entry;
};

struct Group {
  uint32_t general = VK_SHADER_UNUSED_KHR, closest_hit = VK_SHADER_UNUSED_KHR, any_hit = VK_SHADER_UNUSED_KHR,
           intersection = VK_SHADER_UNUSED_KHR;
};

struct Table {  // numbers of groups
  uint32_t raygen = 0;
  std::vector<uint32_t> miss, hit, callable;
};

struct Geometry {
  Range vertices, indices, boxes;  // boxes alone, or vertices and indices
  VkGeometryFlagsKHR flags = 0;
  bool is_boxes() const { return !boxes.buffer.empty(); }
};

struct Picture {
  std::string buffer;  // empty: zeros
  VkFormat format{};
  uint32_t width = 0, height = 0;
  bool repeats = false;
};

struct Binding {
  uint32_t binding = 0;
  VkDescriptorType type{};
  std::string buffer;             // of buffers
  std::vector<Picture> pictures;  // of images
};

struct Frame {
  std::string name;
  std::filesystem::path folder;
  std::array<uint32_t, 3> launch{};
  std::vector<Shader> shaders;
  std::vector<Group> groups;
  Table table;
  uint32_t recursion = 1;
  std::map<std::string, std::filesystem::path> buffers;
  std::vector<std::vector<Geometry>> bottom_levels;
  Range instances;  // records as VkAccelerationStructureInstanceKHR, with numbers of bottom levels for
                    // addresses
  std::vector<Binding> bindings;
  std::string push_constants;  // a buffer, or empty
  uint32_t picture = 0;        // binding of the image that is the result
};

// Reads FOLDER/frame.json. Throws std::runtime_error that names the file and what is wrong with it.
Frame read_frame(const std::filesystem::path& folder);

}  // namespace rt_frames
