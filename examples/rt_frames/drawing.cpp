// Makes descriptors, pipeline and binding table of a frame, and traces it.
// SPDX-License-Identifier: Apache-2.0
#include "drawing.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace rt_frames {
namespace {

constexpr VkShaderStageFlags kAllStages =
    VK_SHADER_STAGE_RAYGEN_BIT_KHR | VK_SHADER_STAGE_ANY_HIT_BIT_KHR | VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR |
    VK_SHADER_STAGE_MISS_BIT_KHR | VK_SHADER_STAGE_INTERSECTION_BIT_KHR | VK_SHADER_STAGE_CALLABLE_BIT_KHR;

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(in), {}};
}

VkBufferImageCopy whole_copy(const Image& image) {
  VkBufferImageCopy out{};
  out.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  out.imageExtent = {image.width, image.height, 1};
  return out;
}

}  // namespace

Functions::Functions(const Device& device) {
  device.load(create_structure, "vkCreateAccelerationStructureKHR");
  device.load(destroy_structure, "vkDestroyAccelerationStructureKHR");
  device.load(build_sizes, "vkGetAccelerationStructureBuildSizesKHR");
  device.load(address_of, "vkGetAccelerationStructureDeviceAddressKHR");
  device.load(build, "vkCmdBuildAccelerationStructuresKHR");
  device.load(create_pipelines, "vkCreateRayTracingPipelinesKHR");
  device.load(handles, "vkGetRayTracingShaderGroupHandlesKHR");
  device.load(trace, "vkCmdTraceRaysKHR");
}

Drawing::Drawing(Device& device, const Frame& frame) : device_(device), frame_(frame), call_(device) {
  for (const auto& [name, file] : frame.buffers) buffers_[name] = device.upload_file(file);
  if (!frame.push_constants.empty()) push_constants_ = bytes_of(frame.buffers.at(frame.push_constants));
  build_structures();
  make_descriptors();
  write_descriptors();
  make_pipeline();
  make_table();
  VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  info.queryType = VK_QUERY_TYPE_TIMESTAMP, info.queryCount = 2;
  check(vkCreateQueryPool(device.device, &info, nullptr, &queries_), "vkCreateQueryPool");
  device.at_end([&device, made = queries_] { vkDestroyQueryPool(device.device, made, nullptr); });
}

void Drawing::make_descriptors() {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  std::vector<VkDescriptorPoolSize> sizes;
  for (const Binding& from : frame_.bindings) {
    const uint32_t count = uint32_t(std::max<size_t>(1, from.pictures.size()));
    bindings.push_back({from.binding, from.type, count, kAllStages, nullptr});
    sizes.push_back({from.type, count});
  }
  VkDescriptorSetLayoutCreateInfo layout{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  layout.bindingCount = uint32_t(bindings.size()), layout.pBindings = bindings.data();
  check(vkCreateDescriptorSetLayout(device_.device, &layout, nullptr, &set_layout_),
        "vkCreateDescriptorSetLayout");
  VkDescriptorPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  pool_info.maxSets = 1, pool_info.poolSizeCount = uint32_t(sizes.size()),
  pool_info.pPoolSizes = sizes.data();
  VkDescriptorPool pool = nullptr;
  check(vkCreateDescriptorPool(device_.device, &pool_info, nullptr, &pool), "vkCreateDescriptorPool");
  VkDescriptorSetAllocateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  set.descriptorPool = pool, set.descriptorSetCount = 1, set.pSetLayouts = &set_layout_;
  check(vkAllocateDescriptorSets(device_.device, &set, &set_), "vkAllocateDescriptorSets");
  const VkPushConstantRange constants{kAllStages, 0, uint32_t(push_constants_.size())};
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.setLayoutCount = 1, info.pSetLayouts = &set_layout_;
  info.pushConstantRangeCount = push_constants_.empty() ? 0 : 1, info.pPushConstantRanges = &constants;
  check(vkCreatePipelineLayout(device_.device, &info, nullptr, &layout_), "vkCreatePipelineLayout");
  device_.at_end([&device = device_, pool, layout = layout_, set_layout = set_layout_] {
    vkDestroyPipelineLayout(device.device, layout, nullptr);
    vkDestroyDescriptorPool(device.device, pool, nullptr);
    vkDestroyDescriptorSetLayout(device.device, set_layout, nullptr);
  });
}

Image Drawing::texture(const Picture& picture) {
  const Image out = device_.image(picture.format, picture.width, picture.height);
  if (picture.buffer.empty()) return out;
  if (buffer(picture.buffer).bytes < VkDeviceSize{4} * picture.width * picture.height)
    throw std::runtime_error("the buffer " + picture.buffer + " is smaller than its image");
  device_.run([&](VkCommandBuffer commands) {
    const VkBufferImageCopy copy = whole_copy(out);
    vkCmdCopyBufferToImage(commands, buffer(picture.buffer).buffer, out.image, VK_IMAGE_LAYOUT_GENERAL, 1,
                           &copy);
  });
  return out;
}

VkSampler Drawing::sampler(bool repeats) {
  VkSampler& out = samplers_[repeats];
  if (out) return out;
  const VkSamplerAddressMode mode =
      repeats ? VK_SAMPLER_ADDRESS_MODE_REPEAT : VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.addressModeU = info.addressModeV = info.addressModeW = mode;
  check(vkCreateSampler(device_.device, &info, nullptr, &out), "vkCreateSampler");
  device_.at_end([&device = device_, made = out] { vkDestroySampler(device.device, made, nullptr); });
  return out;
}

void Drawing::write_descriptors() {
  for (const Binding& from : frame_.bindings) {
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set_, write.dstBinding = from.binding, write.descriptorCount = 1,
    write.descriptorType = from.type;
    VkWriteDescriptorSetAccelerationStructureKHR top{
        VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR};
    top.accelerationStructureCount = 1, top.pAccelerationStructures = &top_.handle;
    VkDescriptorBufferInfo buffer_info{};
    std::vector<VkDescriptorImageInfo> image_infos;
    if (from.type == VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR) write.pNext = &top;
    if (!from.buffer.empty()) buffer_info = {buffer(from.buffer).buffer, 0, VK_WHOLE_SIZE};
    for (const Picture& picture : from.pictures) {
      const bool is_texture = from.type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
      images_[from.binding].push_back(texture(picture));
      image_infos.push_back({is_texture ? sampler(picture.repeats) : nullptr,
                             images_[from.binding].back().view, VK_IMAGE_LAYOUT_GENERAL});
    }
    if (!image_infos.empty()) write.descriptorCount = uint32_t(image_infos.size());
    write.pBufferInfo = &buffer_info, write.pImageInfo = image_infos.data();
    vkUpdateDescriptorSets(device_.device, 1, &write, 0, nullptr);
  }
  if (!images_.count(frame_.picture))
    throw std::runtime_error("no image is bound where the picture should be");
}

void Drawing::make_pipeline() {
  std::vector<VkPipelineShaderStageCreateInfo> stages;
  std::vector<VkShaderModule> modules;
  for (const Shader& shader : frame_.shaders) {
    const std::string code = bytes_of(shader.file);
    std::vector<uint32_t> words(code.size() / sizeof(uint32_t));
    std::memcpy(words.data(), code.data(), words.size() * sizeof words[0]);
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = words.size() * sizeof words[0], info.pCode = words.data();
    check(vkCreateShaderModule(device_.device, &info, nullptr, &modules.emplace_back()),
          "vkCreateShaderModule");
    VkPipelineShaderStageCreateInfo& stage = stages.emplace_back();
    stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    stage.stage = shader.stage, stage.module = modules.back(), stage.pName = shader.entry.c_str();
  }
  std::vector<VkRayTracingShaderGroupCreateInfoKHR> groups;
  for (const Group& from : frame_.groups) {
    VkRayTracingShaderGroupCreateInfoKHR& to = groups.emplace_back();
    to = {VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR};
    to.type = from.general != VK_SHADER_UNUSED_KHR ? VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR
              : from.intersection != VK_SHADER_UNUSED_KHR
                  ? VK_RAY_TRACING_SHADER_GROUP_TYPE_PROCEDURAL_HIT_GROUP_KHR
                  : VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR;
    to.generalShader = from.general, to.closestHitShader = from.closest_hit;
    to.anyHitShader = from.any_hit, to.intersectionShader = from.intersection;
  }
  VkRayTracingPipelineCreateInfoKHR info{VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR};
  info.stageCount = uint32_t(stages.size()), info.pStages = stages.data();
  info.groupCount = uint32_t(groups.size()), info.pGroups = groups.data();
  info.maxPipelineRayRecursionDepth = frame_.recursion, info.layout = layout_;
  check(call_.create_pipelines(device_.device, nullptr, nullptr, 1, &info, nullptr, &pipeline_),
        "vkCreateRayTracingPipelinesKHR");
  for (VkShaderModule module : modules) vkDestroyShaderModule(device_.device, module, nullptr);
  device_.at_end([&device = device_, made = pipeline_] { vkDestroyPipeline(device.device, made, nullptr); });
}

void Drawing::make_table() {
  const auto up = [](uint64_t value, uint64_t to) { return (value + to - 1) / to * to; };
  const uint64_t handle = device_.pipelines.shaderGroupHandleSize;
  const uint64_t stride = up(handle, device_.pipelines.shaderGroupHandleAlignment);
  const uint64_t base = device_.pipelines.shaderGroupBaseAlignment;
  std::vector<std::byte> handles(handle * frame_.groups.size()), bytes;
  check(call_.handles(device_.device, pipeline_, 0, uint32_t(frame_.groups.size()), handles.size(),
                      handles.data()),
        "vkGetRayTracingShaderGroupHandlesKHR");
  const std::array<std::vector<uint32_t>, 4> lists = {std::vector{frame_.table.raygen}, frame_.table.miss,
                                                      frame_.table.hit, frame_.table.callable};
  std::array<VkStridedDeviceAddressRegionKHR*, 4> regions = {&raygen_, &miss_, &hit_, &callable_};
  for (size_t i = 0; i < lists.size(); ++i) {
    const uint64_t first = bytes.size();
    bytes.resize(up(first + lists[i].size() * stride, base));
    for (size_t record = 0; record < lists[i].size(); ++record)
      std::memcpy(bytes.data() + first + record * stride, handles.data() + lists[i][record] * handle, handle);
    if (!lists[i].empty()) *regions[i] = {first, stride, lists[i].size() * stride};
  }
  const Buffer table = device_.device_buffer(bytes.size() + base);
  const VkDeviceAddress start = up(table.address, base);
  std::vector<std::byte> moved(bytes.size() + base);
  std::copy(bytes.begin(), bytes.end(), moved.begin() + std::ptrdiff_t(start - table.address));
  const Buffer from = device_.host_buffer(moved.size());
  std::memcpy(from.data, moved.data(), moved.size());
  device_.run([&](VkCommandBuffer commands) {
    const VkBufferCopy copy{0, 0, moved.size()};
    vkCmdCopyBuffer(commands, from.buffer, table.buffer, 1, &copy);
  });
  for (VkStridedDeviceAddressRegionKHR* region : regions)
    if (region->size) region->deviceAddress += start;
  raygen_.stride = raygen_.size;
}

double Drawing::trace() {
  device_.run([&](VkCommandBuffer commands) {
    vkCmdResetQueryPool(commands, queries_, 0, 2);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, pipeline_);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR, layout_, 0, 1, &set_, 0,
                            nullptr);
    if (!push_constants_.empty())
      vkCmdPushConstants(commands, layout_, kAllStages, 0, uint32_t(push_constants_.size()),
                         push_constants_.data());
    const auto stamp = [&](uint32_t query) {
      vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, queries_, query);
    };
    stamp(0);
    const auto [width, height, depth] = frame_.launch;
    call_.trace(commands, &raygen_, &miss_, &hit_, &callable_, width, height, depth);
    stamp(1);
  });
  std::array<uint64_t, 2> stamps{};
  check(vkGetQueryPoolResults(device_.device, queries_, 0, 2, sizeof stamps, stamps.data(), sizeof stamps[0],
                              VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
        "vkGetQueryPoolResults");
  const uint64_t mask =
      device_.timestamp_bits < 64 ? (uint64_t{1} << device_.timestamp_bits) - 1 : ~uint64_t{0};
  return double((stamps[1] - stamps[0]) & mask) * device_.timestamp_period;
}

std::string Drawing::picture() {
  const Image& image = images_.at(frame_.picture)[0];
  if (image.format != VK_FORMAT_R32G32B32A32_SFLOAT) throw std::runtime_error("the picture is not of floats");
  const Buffer host = device_.host_buffer(VkDeviceSize{16} * image.width * image.height);
  device_.run([&](VkCommandBuffer commands) {
    VkMemoryBarrier done{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_SHADER_WRITE_BIT,
                         VK_ACCESS_TRANSFER_READ_BIT};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_RAY_TRACING_SHADER_BIT_KHR,
                         VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1, &done, 0, nullptr, 0, nullptr);
    const VkBufferImageCopy copy = whole_copy(image);
    vkCmdCopyImageToBuffer(commands, image.image, VK_IMAGE_LAYOUT_GENERAL, host.buffer, 1, &copy);
  });
  std::string out = "PF\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n-1.0\n";
  for (size_t row = image.height; row-- > 0;)
    for (size_t x = 0; x < image.width; ++x)
      out.append(reinterpret_cast<const char*>(host.data) + (row * image.width + x) * 16, 12);
  return out;
}

}  // namespace rt_frames
