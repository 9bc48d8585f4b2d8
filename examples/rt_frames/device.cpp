// Opens a device, and makes and fills its buffers and images.
// SPDX-License-Identifier: Apache-2.0
#include "device.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace rt_frames {
namespace {

constexpr VkDeviceSize kStaging = 32 << 20;  // bytes that are copied at a time
constexpr std::array kExtensions = {VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                                    VK_KHR_RAY_TRACING_PIPELINE_EXTENSION_NAME,
                                    VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};

bool traces_rays(VkPhysicalDevice device) {
  uint32_t count = 0;
  check(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr), "reading extensions");
  std::vector<VkExtensionProperties> all(count);
  check(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, all.data()), "reading extensions");
  return std::all_of(kExtensions.begin(), kExtensions.end(), [&](const char* wanted) {
    return std::any_of(all.begin(), all.end(), [&](const VkExtensionProperties& one) {
      return !std::strcmp(one.extensionName, wanted);
    });
  });
}

}  // namespace

void check(VkResult result, const std::string& call) {
  if (result < 0)
    throw std::runtime_error(
        call + " failed with VkResult " + std::to_string(int(result)) +
        (result == VK_ERROR_OUT_OF_DEVICE_MEMORY ? ": the device has no memory left" : ""));
}

void Device::throw_missing(const char* function) {
  throw std::runtime_error(std::string("the device has no function ") + function);
}

Device::Device(const std::string& wanted) {
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = "rt_frames";
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  check(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
  choose(wanted);
  make_device();
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.queueFamilyIndex = family_;
  check(vkCreateCommandPool(device, &pool, nullptr, &pool_), "vkCreateCommandPool");
  staging_ = host_buffer(kStaging);
}

Device::~Device() {
  vkDeviceWaitIdle(device);
  for (auto end = ends_.rbegin(); end != ends_.rend(); ++end) (*end)();
  vkDestroyCommandPool(device, pool_, nullptr);
  vkDestroyDevice(device, nullptr);
  vkDestroyInstance(instance, nullptr);
}

void Device::choose(const std::string& wanted) {
  uint32_t count = 0;
  check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> all(count);
  check(vkEnumeratePhysicalDevices(instance, &count, all.data()), "vkEnumeratePhysicalDevices");
  std::string seen;
  for (VkPhysicalDevice each : all) {
    VkPhysicalDeviceDriverProperties driver_is{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    structures = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR, &driver_is};
    pipelines = {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR, &structures};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &pipelines};
    vkGetPhysicalDeviceProperties2(each, &properties);
    name = properties.properties.deviceName;
    driver = std::string(driver_is.driverName) + " " + driver_is.driverInfo;
    timestamp_period = properties.properties.limits.timestampPeriod;
    seen += "\n  " + name;
    if (name.find(wanted) == std::string::npos || properties.properties.apiVersion < VK_API_VERSION_1_3 ||
        !traces_rays(each))
      continue;
    physical = each;
    return;
  }
  throw std::runtime_error("no device with Vulkan 1.3 and ray-tracing pipelines" +
                           (wanted.empty() ? "" : " whose name holds '" + wanted + "'") +
                           "; the devices are:" + (seen.empty() ? "\n  none" : seen));
}

void Device::make_device() {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  const auto computes =
      std::find_if(families.begin(), families.end(), [](const VkQueueFamilyProperties& family) {
        return (family.queueFlags & VK_QUEUE_COMPUTE_BIT) && family.timestampValidBits;
      });
  if (computes == families.end()) throw std::runtime_error(name + " has no queue with timestamps");
  family_ = uint32_t(computes - families.begin());
  timestamp_bits = computes->timestampValidBits;

  VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipeline{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR};
  pipeline.rayTracingPipeline = VK_TRUE;
  VkPhysicalDeviceAccelerationStructureFeaturesKHR structure{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR, &pipeline};
  structure.accelerationStructure = VK_TRUE;
  VkPhysicalDeviceVulkan12Features core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &structure};
  core.bufferDeviceAddress = core.descriptorIndexing = core.runtimeDescriptorArray = VK_TRUE;
  core.shaderSampledImageArrayNonUniformIndexing = VK_TRUE;
  const float priority = 1;
  VkDeviceQueueCreateInfo queues{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queues.queueFamilyIndex = family_, queues.queueCount = 1, queues.pQueuePriorities = &priority;
  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &core};
  info.queueCreateInfoCount = 1, info.pQueueCreateInfos = &queues;
  info.enabledExtensionCount = uint32_t(kExtensions.size()),
  info.ppEnabledExtensionNames = kExtensions.data();
  check(vkCreateDevice(physical, &info, nullptr, &device), "vkCreateDevice");
  vkGetDeviceQueue(device, family_, 0, &queue);
}

uint32_t Device::memory_type(uint32_t allowed, VkMemoryPropertyFlags wanted) const {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(physical, &memory);
  for (uint32_t type = 0; type < memory.memoryTypeCount; ++type)
    if ((allowed >> type & 1) && (memory.memoryTypes[type].propertyFlags & wanted) == wanted) return type;
  throw std::runtime_error(name + " has no memory of the kind " + std::to_string(wanted));
}

VkDeviceMemory Device::allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted,
                                bool has_address) {
  VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
  flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, has_address ? &flags : nullptr};
  info.allocationSize = needs.size, info.memoryTypeIndex = memory_type(needs.memoryTypeBits, wanted);
  VkDeviceMemory memory = nullptr;
  check(vkAllocateMemory(device, &info, nullptr, &memory),
        "vkAllocateMemory of " + std::to_string(needs.size) + " bytes");
  at_end([this, memory] { vkFreeMemory(device, memory, nullptr); });
  return memory;
}

Buffer Device::buffer(VkDeviceSize bytes, VkMemoryPropertyFlags wanted) {
  Buffer out;
  out.bytes = std::max<VkDeviceSize>(bytes, 4);
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = out.bytes;
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
               VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
               VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR |
               VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR |
               VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
  check(vkCreateBuffer(device, &info, nullptr, &out.buffer), "vkCreateBuffer");
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device, out.buffer, &needs);
  const VkDeviceMemory memory = allocate(needs, wanted, true);
  check(vkBindBufferMemory(device, out.buffer, memory, 0), "vkBindBufferMemory");
  at_end([this, made = out.buffer] { vkDestroyBuffer(device, made, nullptr); });
  const VkBufferDeviceAddressInfo where{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, nullptr, out.buffer};
  out.address = vkGetBufferDeviceAddress(device, &where);
  if (wanted & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) {
    void* data = nullptr;
    check(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &data), "vkMapMemory");
    out.data = static_cast<std::byte*>(data);
  }
  return out;
}

Buffer Device::device_buffer(VkDeviceSize bytes) {
  return buffer(bytes, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
}

Buffer Device::host_buffer(VkDeviceSize bytes) {
  return buffer(bytes, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
}

Buffer Device::upload(const void* data, VkDeviceSize bytes) {
  const Buffer out = device_buffer(bytes);
  for (VkDeviceSize at = 0; at < bytes; at += kStaging) {
    const VkDeviceSize part = std::min(kStaging, bytes - at);
    std::memcpy(staging_.data, static_cast<const std::byte*>(data) + at, part);
    run([&](VkCommandBuffer commands) {
      const VkBufferCopy copy{0, at, part};
      vkCmdCopyBuffer(commands, staging_.buffer, out.buffer, 1, &copy);
    });
  }
  return out;
}

Buffer Device::upload_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::error_code failed;
  const uint64_t bytes = std::filesystem::file_size(file, failed);
  if (!in || failed) throw std::runtime_error("cannot read " + file.string());
  const Buffer out = device_buffer(bytes);
  for (VkDeviceSize at = 0; at < bytes; at += kStaging) {
    const VkDeviceSize part = std::min<VkDeviceSize>(kStaging, bytes - at);
    if (!in.read(reinterpret_cast<char*>(staging_.data), std::streamsize(part)))
      throw std::runtime_error("cannot read " + file.string());
    run([&](VkCommandBuffer commands) {
      const VkBufferCopy copy{0, at, part};
      vkCmdCopyBuffer(commands, staging_.buffer, out.buffer, 1, &copy);
    });
  }
  return out;
}

Image Device::image(VkFormat format, uint32_t width, uint32_t height) {
  Image out{nullptr, nullptr, format, width, height};
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D, info.format = format, info.extent = {width, height, 1};
  info.mipLevels = info.arrayLayers = 1, info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  info.usage |=
      format == VK_FORMAT_R32G32B32A32_SFLOAT ? VK_IMAGE_USAGE_STORAGE_BIT : VK_IMAGE_USAGE_SAMPLED_BIT;
  check(vkCreateImage(device, &info, nullptr, &out.image), "vkCreateImage");
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device, out.image, &needs);
  check(vkBindImageMemory(device, out.image, allocate(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, false), 0),
        "vkBindImageMemory");
  VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view.image = out.image, view.viewType = VK_IMAGE_VIEW_TYPE_2D, view.format = format;
  view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  check(vkCreateImageView(device, &view, nullptr, &out.view), "vkCreateImageView");
  at_end([this, out] {
    vkDestroyImageView(device, out.view, nullptr);
    vkDestroyImage(device, out.image, nullptr);
  });
  run([&](VkCommandBuffer commands) {
    VkImageMemoryBarrier ready{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    ready.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT, ready.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    ready.srcQueueFamilyIndex = ready.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    ready.image = out.image, ready.subresourceRange = view.subresourceRange;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0,
                         nullptr, 0, nullptr, 1, &ready);
    const VkClearColorValue zero{};
    vkCmdClearColorImage(commands, out.image, VK_IMAGE_LAYOUT_GENERAL, &zero, 1, &view.subresourceRange);
  });
  return out;
}

void Device::run(const std::function<void(VkCommandBuffer)>& commands) {
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  info.commandPool = pool_, info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY, info.commandBufferCount = 1;
  VkCommandBuffer recorded = nullptr;
  check(vkAllocateCommandBuffers(device, &info, &recorded), "vkAllocateCommandBuffers");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(recorded, &begin), "vkBeginCommandBuffer");
  commands(recorded);
  check(vkEndCommandBuffer(recorded), "vkEndCommandBuffer");
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1, submit.pCommandBuffers = &recorded;
  check(vkQueueSubmit(queue, 1, &submit, nullptr), "vkQueueSubmit");
  check(vkQueueWaitIdle(queue), "waiting for the device");
  vkFreeCommandBuffers(device, pool_, 1, &recorded);
}

}  // namespace rt_frames
