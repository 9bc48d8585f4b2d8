// Is a small Vulkan program: what the tests of the driver need of an application, over the system's loader.
// SPDX-License-Identifier: Apache-2.0
#include "tests/vulkan/client.h"

#include <iostream>
#include <stdexcept>

#include "frontend/compile.h"

namespace glint::test {
namespace {

VKAPI_ATTR VkBool32 VKAPI_CALL hear(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                    VkDebugUtilsMessageTypeFlagsEXT,
                                    const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  auto& client = *static_cast<Client*>(user);
  if (severity >= VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT) {
    client.messages.emplace_back(data->pMessage);
    std::cerr << "heard: " << data->pMessage << "\n";
  } else if (data->pMessageIdName && std::string(data->pMessageIdName) == "glint")
    client.prints += data->pMessage;
  return VK_FALSE;
}

}  // namespace

void check(VkResult result, const std::string& call) {
  if (result < 0) throw std::runtime_error(call + " returned " + std::to_string(result));
}

Client::Client(const Options& options) {
  make_instance(options);
  make_device(options);
}

Client::~Client() {
  if (device) vkDeviceWaitIdle(device);
  while (!ends_.empty()) {
    ends_.back()();
    ends_.pop_back();
  }
}

void Client::make_instance(const Options& options) {
  VkApplicationInfo application{};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.apiVersion = VK_API_VERSION_1_3;
  VkDebugUtilsMessengerCreateInfoEXT listener{};
  listener.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
  listener.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT |
                             VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                             VK_DEBUG_UTILS_MESSAGE_SEVERITY_INFO_BIT_EXT;
  listener.messageType =
      VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  listener.pfnUserCallback = hear, listener.pUserData = this;
  std::vector<const char*> extensions = options.instance_extensions;
  extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  VkInstanceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, info.pApplicationInfo = &application;
  info.enabledExtensionCount = uint32_t(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  info.enabledLayerCount = uint32_t(options.layers.size()), info.ppEnabledLayerNames = options.layers.data();
  check(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
  ends_.emplace_back([this] { vkDestroyInstance(instance, nullptr); });
  const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
  check(create(instance, &listener, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");
  ends_.emplace_back([this] {
    reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"))(instance, messenger_, nullptr);
  });
}

void Client::make_device(const Options& options) {
  uint32_t count = 1;
  check(vkEnumeratePhysicalDevices(instance, &count, &physical), "vkEnumeratePhysicalDevices");
  if (!count) throw std::runtime_error("there is no Vulkan device");
  const std::vector<float> priorities(options.queues, 1.0f);
  VkDeviceQueueCreateInfo queues{};
  queues.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, queues.queueCount = options.queues;
  queues.pQueuePriorities = priorities.data();
  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  // glslang writes LocalSizeId into modules of SPIR-V 1.6, which Vulkan ties to this feature.
  VkPhysicalDeviceMaintenance4Features sizes{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES,
                                             const_cast<void*>(options.more_features), VK_TRUE};
  info.pNext = &sizes;
  info.queueCreateInfoCount = 1, info.pQueueCreateInfos = &queues;
  info.enabledExtensionCount = uint32_t(options.extensions.size());
  info.ppEnabledExtensionNames = options.extensions.data();
  info.pEnabledFeatures = &options.features;
  check(vkCreateDevice(physical, &info, nullptr, &device), "vkCreateDevice");
  ends_.emplace_back([this] { vkDestroyDevice(device, nullptr); });
  vkGetDeviceQueue(device, 0, 0, &queue);
  VkCommandPoolCreateInfo pools{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, 0};
  check(vkCreateCommandPool(device, &pools, nullptr, &pool), "vkCreateCommandPool");
  ends_.emplace_back([this] { vkDestroyCommandPool(device, pool, nullptr); });
}

uint32_t Client::host_memory_type() const {
  VkPhysicalDeviceMemoryProperties types;
  vkGetPhysicalDeviceMemoryProperties(physical, &types);
  constexpr VkMemoryPropertyFlags kWanted =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  for (uint32_t i = 0; i < types.memoryTypeCount; ++i)
    if ((types.memoryTypes[i].propertyFlags & kWanted) == kWanted) return i;
  throw std::runtime_error("there is no memory that the host can map");
}

VkDeviceMemory Client::allocate(const VkMemoryRequirements& needs, const void* more) {
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, more, needs.size, host_memory_type()};
  VkDeviceMemory out = nullptr;
  check(vkAllocateMemory(device, &info, nullptr, &out), "vkAllocateMemory");
  ends_.emplace_back([this, out] { vkFreeMemory(device, out, nullptr); });
  return out;
}

MappedBuffer Client::buffer(VkDeviceSize bytes, VkBufferUsageFlags usage) {
  MappedBuffer out;
  out.bytes = bytes;
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, info.size = bytes, info.usage = usage;
  check(vkCreateBuffer(device, &info, nullptr, &out.buffer), "vkCreateBuffer");
  ends_.emplace_back([this, made = out.buffer] { vkDestroyBuffer(device, made, nullptr); });
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device, out.buffer, &needs);
  VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO, nullptr,
                                  VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT, 0};
  const bool has_address = (usage & VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT) != 0;
  out.memory = allocate(needs, has_address ? &flags : nullptr);
  check(vkBindBufferMemory(device, out.buffer, out.memory, 0), "vkBindBufferMemory");
  check(vkMapMemory(device, out.memory, 0, VK_WHOLE_SIZE, 0, &out.data), "vkMapMemory");
  return out;
}

VkImage Client::bound_image(const VkImageCreateInfo& info) {
  VkImage out = nullptr;
  check(vkCreateImage(device, &info, nullptr, &out), "vkCreateImage");
  ends_.emplace_back([this, out] { vkDestroyImage(device, out, nullptr); });
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device, out, &needs);
  check(vkBindImageMemory(device, out, allocate(needs), 0), "vkBindImageMemory");
  check(run([&](VkCommandBuffer commands) {
          VkImageMemoryBarrier barrier{};
          barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER, barrier.image = out;
          barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL,
          barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, info.mipLevels, 0, info.arrayLayers};
          barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
          vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                               VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
        }),
        "the change of layout");
  return out;
}

BoundImage Client::image(VkFormat format, VkExtent3D extent, uint32_t levels, uint32_t layers,
                         VkComponentMapping swizzle, VkSampleCountFlagBits samples) {
  BoundImage out;
  out.all = {VK_IMAGE_ASPECT_COLOR_BIT, 0, levels, 0, layers};
  const bool has_depth = extent.depth > 1;
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = has_depth ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
  info.format = format, info.extent = extent, info.mipLevels = levels, info.arrayLayers = layers;
  info.samples = samples, info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  VkFormatProperties can;
  vkGetPhysicalDeviceFormatProperties(physical, format, &can);
  if (can.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT)
    info.usage |= VK_IMAGE_USAGE_STORAGE_BIT;
  out.image = bound_image(info);
  VkImageViewCreateInfo view{};
  view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, view.image = out.image, view.format = format;
  view.viewType = has_depth    ? VK_IMAGE_VIEW_TYPE_3D
                  : layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY
                               : VK_IMAGE_VIEW_TYPE_2D;
  view.components = swizzle, view.subresourceRange = out.all;
  check(vkCreateImageView(device, &view, nullptr, &out.view), "vkCreateImageView");
  ends_.emplace_back([this, made = out.view] { vkDestroyImageView(device, made, nullptr); });
  return out;
}

VkSampler Client::sampler(VkFilter filter, VkSamplerAddressMode mode, float anisotropy) {
  VkSamplerCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
  info.magFilter = info.minFilter = filter;
  info.addressModeU = info.addressModeV = info.addressModeW = mode;
  info.maxLod = VK_LOD_CLAMP_NONE;
  info.anisotropyEnable = anisotropy > 1, info.maxAnisotropy = anisotropy;
  VkSampler out = nullptr;
  check(vkCreateSampler(device, &info, nullptr, &out), "vkCreateSampler");
  ends_.emplace_back([this, out] { vkDestroySampler(device, out, nullptr); });
  return out;
}

VkResult Client::upload(const MappedBuffer& from, const BoundImage& to, VkExtent3D extent) {
  const VkBufferImageCopy region{0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, to.all.layerCount}, {}, extent};
  return run([&](VkCommandBuffer commands) {
    vkCmdCopyBufferToImage(commands, from.buffer, to.image, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
  });
}
VkResult Client::download(const BoundImage& from, const MappedBuffer& to, VkExtent3D extent) {
  const VkBufferImageCopy region{0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, from.all.layerCount}, {}, extent};
  return run([&](VkCommandBuffer commands) {
    vkCmdCopyImageToBuffer(commands, from.image, VK_IMAGE_LAYOUT_GENERAL, to.buffer, 1, &region);
  });
}

VkBuffer Client::import(void* bytes, VkDeviceSize size) {
  constexpr auto kHost = VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT;
  VkExternalMemoryBufferCreateInfo external{VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO, nullptr,
                                            kHost};
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, info.pNext = &external;
  info.size = size, info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  VkBuffer out = nullptr;
  check(vkCreateBuffer(device, &info, nullptr, &out), "vkCreateBuffer");
  ends_.emplace_back([this, out] { vkDestroyBuffer(device, out, nullptr); });
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device, out, &needs);
  needs.size = size;
  const VkImportMemoryHostPointerInfoEXT import{VK_STRUCTURE_TYPE_IMPORT_MEMORY_HOST_POINTER_INFO_EXT,
                                                nullptr, kHost, bytes};
  check(vkBindBufferMemory(device, out, allocate(needs, &import), 0), "vkBindBufferMemory");
  return out;
}

VkShaderModule Client::module(const std::string& glsl, VkShaderStageFlagBits stage, const std::string& path) {
  const auto [name, own_stage] = [&]() -> std::pair<const char*, isa::Stage> {
    switch (stage) {
      case VK_SHADER_STAGE_RAYGEN_BIT_KHR:
        return {"client.rgen", isa::Stage::RayGeneration};
      case VK_SHADER_STAGE_MISS_BIT_KHR:
        return {"client.rmiss", isa::Stage::Miss};
      case VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR:
        return {"client.rchit", isa::Stage::ClosestHit};
      case VK_SHADER_STAGE_ANY_HIT_BIT_KHR:
        return {"client.rahit", isa::Stage::AnyHit};
      case VK_SHADER_STAGE_INTERSECTION_BIT_KHR:
        return {"client.rint", isa::Stage::Intersection};
      case VK_SHADER_STAGE_CALLABLE_BIT_KHR:
        return {"client.rcall", isa::Stage::Callable};
      default:
        return {"client.comp", isa::Stage::Compute};
    }
  }();
  return module(frontend::glsl_text_to_spirv(glsl, path.empty() ? name : path, own_stage, {}));
}

VkShaderModule Client::module(const std::vector<uint32_t>& words) {
  VkShaderModuleCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  info.codeSize = words.size() * sizeof(uint32_t), info.pCode = words.data();
  VkShaderModule out = nullptr;
  check(vkCreateShaderModule(device, &info, nullptr, &out), "vkCreateShaderModule");
  ends_.emplace_back([this, out] { vkDestroyShaderModule(device, out, nullptr); });
  return out;
}

ComputePipeline Client::pipeline(const std::string& glsl, const PipelineOptions& options) {
  ComputePipeline out;
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (uint32_t i = 0; i < options.bindings.size(); ++i) {
    const bool is_inline = options.bindings[i] == VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK;
    const uint32_t count = options.counts.empty() ? 1 : options.counts[i];
    bindings.push_back({options.numbers.empty() ? i : options.numbers[i], options.bindings[i],
                        is_inline ? options.inline_bytes : count, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
  }
  VkDescriptorSetLayoutCreateInfo sets{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, nullptr,
                                       options.set_flags, uint32_t(bindings.size()), bindings.data()};
  check(vkCreateDescriptorSetLayout(device, &sets, nullptr, &out.set_layout), "vkCreateDescriptorSetLayout");
  const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, options.push_constant_bytes};
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                    nullptr,
                                    0,
                                    1,
                                    &out.set_layout,
                                    range.size ? 1u : 0u,
                                    &range};
  check(vkCreatePipelineLayout(device, &layout, nullptr, &out.layout), "vkCreatePipelineLayout");
  VkComputePipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO, info.layout = out.layout;
  info.pNext = options.more_info;
  info.flags = VK_PIPELINE_CREATE_DISPATCH_BASE | options.flags;
  info.stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                options.more_stage_info,
                0,
                VK_SHADER_STAGE_COMPUTE_BIT,
                options.module ? options.module : module(glsl),
                "main",
                options.constants};
  check(vkCreateComputePipelines(device, nullptr, 1, &info, nullptr, &out.pipeline),
        "vkCreateComputePipelines");
  ends_.emplace_back([this, out] {
    vkDestroyPipeline(device, out.pipeline, nullptr);
    vkDestroyPipelineLayout(device, out.layout, nullptr);
    vkDestroyDescriptorSetLayout(device, out.set_layout, nullptr);
  });
  return out;
}

VkDescriptorSet Client::set(VkDescriptorSetLayout layout, const std::vector<VkDescriptorBufferInfo>& buffers,
                            VkDescriptorType type) {
  const VkDescriptorPoolSize size{type, uint32_t(buffers.size())};
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, nullptr, 0, 1, 1, &size};
  VkDescriptorPool made = nullptr;
  check(vkCreateDescriptorPool(device, &info, nullptr, &made), "vkCreateDescriptorPool");
  ends_.emplace_back([this, made] { vkDestroyDescriptorPool(device, made, nullptr); });
  VkDescriptorSetAllocateInfo wanted{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, made, 1,
                                     &layout};
  VkDescriptorSet out = nullptr;
  check(vkAllocateDescriptorSets(device, &wanted, &out), "vkAllocateDescriptorSets");
  for (uint32_t i = 0; i < buffers.size(); ++i) {
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, write.dstSet = out, write.dstBinding = i;
    write.descriptorCount = 1, write.descriptorType = type, write.pBufferInfo = &buffers[i];
    vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
  }
  return out;
}

VkDescriptorSet Client::set_with_image(VkDescriptorSetLayout layout, const MappedBuffer& buffer,
                                       VkDescriptorType type, const VkDescriptorImageInfo& image) {
  constexpr VkDescriptorType kBuffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  const VkDescriptorPoolSize sizes[] = {{kBuffer, 1}, {type, 1}};
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, nullptr, 0, 1, 2, sizes};
  VkDescriptorPool made = nullptr;
  check(vkCreateDescriptorPool(device, &info, nullptr, &made), "vkCreateDescriptorPool");
  ends_.emplace_back([this, made] { vkDestroyDescriptorPool(device, made, nullptr); });
  VkDescriptorSetAllocateInfo wanted{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, made, 1,
                                     &layout};
  VkDescriptorSet out = nullptr;
  check(vkAllocateDescriptorSets(device, &wanted, &out), "vkAllocateDescriptorSets");
  const VkDescriptorBufferInfo all{buffer.buffer, 0, VK_WHOLE_SIZE};
  VkWriteDescriptorSet writes[2]{};
  for (uint32_t i = 0; i < 2; ++i) {
    writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, writes[i].dstSet = out;
    writes[i].dstBinding = i, writes[i].descriptorCount = 1, writes[i].descriptorType = i ? type : kBuffer;
    writes[i].pBufferInfo = &all, writes[i].pImageInfo = &image;
  }
  vkUpdateDescriptorSets(device, 2, writes, 0, nullptr);
  return out;
}

VkFence Client::fence() {
  VkFenceCreateInfo info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, 0};
  VkFence out = nullptr;
  check(vkCreateFence(device, &info, nullptr, &out), "vkCreateFence");
  ends_.emplace_back([this, out] { vkDestroyFence(device, out, nullptr); });
  return out;
}

VkSemaphore Client::timeline(uint64_t value) {
  VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO, nullptr,
                                 VK_SEMAPHORE_TYPE_TIMELINE, value};
  VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type, 0};
  VkSemaphore out = nullptr;
  check(vkCreateSemaphore(device, &info, nullptr, &out), "vkCreateSemaphore");
  ends_.emplace_back([this, out] { vkDestroySemaphore(device, out, nullptr); });
  return out;
}

VkResult Client::record(VkCommandBuffer& out, const std::function<void(VkCommandBuffer)>& commands) {
  VkCommandBufferAllocateInfo wanted{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool,
                                     VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
  check(vkAllocateCommandBuffers(device, &wanted, &out), "vkAllocateCommandBuffers");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr, 0, nullptr};
  check(vkBeginCommandBuffer(out, &begin), "vkBeginCommandBuffer");
  commands(out);
  return vkEndCommandBuffer(out);
}

VkResult Client::run(const std::function<void(VkCommandBuffer)>& commands) {
  VkCommandBuffer recorded = nullptr;
  VkResult result = record(recorded, commands);
  VkSubmitInfo submit{};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.commandBufferCount = 1, submit.pCommandBuffers = &recorded;
  if (result == VK_SUCCESS) result = vkQueueSubmit(queue, 1, &submit, nullptr);
  if (result == VK_SUCCESS) result = vkQueueWaitIdle(queue);
  vkFreeCommandBuffers(device, pool, 1, &recorded);
  return result;
}

VkResult Client::dispatch(const ComputePipeline& pipeline, VkDescriptorSet set,
                          std::array<uint32_t, 3> groups, const std::vector<uint32_t>& push_constants) {
  return run([&](VkCommandBuffer commands) {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
    if (set)
      vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &set, 0,
                              nullptr);
    if (!push_constants.empty())
      vkCmdPushConstants(commands, pipeline.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                         uint32_t(push_constants.size() * sizeof(uint32_t)), push_constants.data());
    vkCmdDispatch(commands, groups[0], groups[1], groups[2]);
  });
}

}  // namespace glint::test
