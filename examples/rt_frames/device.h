// Owns a Vulkan device that traces rays, with what every part of the program needs of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>
#include <vulkan/vulkan.h>

namespace rt_frames {

// Throws std::runtime_error that names the call when the result is an error.
void check(VkResult result, const std::string& call);

struct Buffer {
  VkBuffer buffer = nullptr;
  VkDeviceSize bytes = 0;
  VkDeviceAddress address = 0;
  std::byte* data = nullptr;  // of buffers of the host
};

struct Image {
  VkImage image = nullptr;
  VkImageView view = nullptr;
  VkFormat format{};
  uint32_t width = 0, height = 0;
};

class Device {
 public:
  // Opens the first device with ray-tracing pipelines whose name holds `wanted`.
  explicit Device(const std::string& wanted);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  // Makes buffers for every use, in memory of the device or of the host.
  Buffer device_buffer(VkDeviceSize bytes);
  Buffer host_buffer(VkDeviceSize bytes);
  Buffer upload(const void* data, VkDeviceSize bytes);
  Buffer upload_file(const std::filesystem::path& file);
  // Makes an image in the layout "general". Its texels are zero.
  Image image(VkFormat format, uint32_t width, uint32_t height);
  // Records commands, submits them and waits for them.
  void run(const std::function<void(VkCommandBuffer)>& commands);
  // Lets `end` run before the device goes, in the opposite order of these calls.
  void at_end(std::function<void()> end) { ends_.push_back(std::move(end)); }
  template <class Function>
  void load(Function& to, const char* function) const {
    to = reinterpret_cast<Function>(vkGetDeviceProcAddr(device, function));
    if (!to) throw_missing(function);
  }

  VkInstance instance = nullptr;
  VkPhysicalDevice physical = nullptr;
  VkDevice device = nullptr;
  VkQueue queue = nullptr;
  std::string name, driver;
  double timestamp_period = 0;  // ns
  uint32_t timestamp_bits = 0;
  VkPhysicalDeviceRayTracingPipelinePropertiesKHR pipelines{};
  VkPhysicalDeviceAccelerationStructurePropertiesKHR structures{};

 private:
  [[noreturn]] static void throw_missing(const char* function);
  void choose(const std::string& wanted);
  void make_device();
  Buffer buffer(VkDeviceSize bytes, VkMemoryPropertyFlags wanted);
  uint32_t memory_type(uint32_t allowed, VkMemoryPropertyFlags wanted) const;
  VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags wanted, bool has_address);

  uint32_t family_ = 0;
  VkCommandPool pool_ = nullptr;
  Buffer staging_;
  std::vector<std::function<void()>> ends_;
};

}  // namespace rt_frames
