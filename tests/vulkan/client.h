// Is a small Vulkan program: what the tests of the driver need of an application, over the system's loader.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>
#include <vulkan/vulkan.h>

namespace glint::test {

// Throws std::runtime_error that names the call when the result is an error.
void check(VkResult result, const std::string& call);

struct MappedBuffer {
  VkBuffer buffer = nullptr;
  VkDeviceMemory memory = nullptr;
  VkDeviceSize bytes = 0;
  void* data = nullptr;
  template <class T>
  std::span<T> as() const {
    return {static_cast<T*>(data), size_t(bytes / sizeof(T))};
  }
};

struct BoundImage {
  VkImage image = nullptr;
  VkImageView view = nullptr;  // of all levels and layers
  VkImageSubresourceRange all{};
};

struct ComputePipeline {
  VkDescriptorSetLayout set_layout = nullptr;
  VkPipelineLayout layout = nullptr;
  VkPipeline pipeline = nullptr;
};

struct PipelineOptions {
  std::vector<VkDescriptorType> bindings;  // of set 0
  uint32_t push_constant_bytes = 0;
  const VkSpecializationInfo* constants = nullptr;
  VkDescriptorSetLayoutCreateFlags set_flags = 0;
  uint32_t inline_bytes = 0;        // of each inline uniform block
  std::vector<uint32_t> numbers{};  // of the bindings; empty: from 0 on
  VkPipelineCreateFlags flags = 0;
  std::vector<uint32_t> counts{};   // descriptors of the bindings; empty: one each
  VkShaderModule module = nullptr;  // instead of the text
  const void *more_info = nullptr, *more_stage_info = nullptr;  // pNext of the pipeline and of its stage
};

// Holds an instance with a messenger, a device and a command pool. Everything that it made ends with it.
class Client {
 public:
  struct Options {
    std::vector<const char*> layers{}, extensions{};
    std::vector<const char*> instance_extensions{};
    VkPhysicalDeviceFeatures features{};
    const void* more_features = nullptr;  // pNext of the device
    uint32_t queues = 1;
  };
  Client() : Client(Options{}) {}
  explicit Client(const Options& options);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  MappedBuffer buffer(VkDeviceSize bytes, VkBufferUsageFlags usage = kAllUses);
  // Makes an image with one view, and gives it the layout "general". Images with depth 1 have two axes.
  BoundImage image(VkFormat format, VkExtent3D extent, uint32_t levels = 1, uint32_t layers = 1,
                   VkComponentMapping swizzle = {}, VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT);
  // Makes an image, binds it to memory, and gives it the layout "general".
  VkImage bound_image(const VkImageCreateInfo& info);
  // `anisotropy` 1 makes a sampler without it.
  VkSampler sampler(VkFilter filter, VkSamplerAddressMode mode, float anisotropy = 1);
  // Fills level 0 of an image from a buffer, or a buffer from it.
  VkResult upload(const MappedBuffer& from, const BoundImage& to, VkExtent3D extent);
  VkResult download(const BoundImage& from, const MappedBuffer& to, VkExtent3D extent);
  // Makes a buffer over bytes of the host.
  VkBuffer import(void* bytes, VkDeviceSize size);
  // `path` names the text in messages, and its includes lie beside it.
  VkShaderModule module(const std::string& glsl, VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT,
                        const std::string& path = {});
  VkShaderModule module(const std::vector<uint32_t>& words);
  ComputePipeline pipeline(const std::string& glsl, const PipelineOptions& options);
  // Returns a set in which binding i has buffer i.
  VkDescriptorSet set(VkDescriptorSetLayout layout, const std::vector<VkDescriptorBufferInfo>& buffers,
                      VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
  // Returns a set with a storage buffer at binding 0 and an image at binding 1.
  VkDescriptorSet set_with_image(VkDescriptorSetLayout layout, const MappedBuffer& buffer,
                                 VkDescriptorType type, const VkDescriptorImageInfo& image);
  void at_end(std::function<void()> end) { ends_.push_back(std::move(end)); }
  VkFence fence();
  VkSemaphore timeline(uint64_t value);

  // Records commands and ends the recording. Returns the result of its end.
  VkResult record(VkCommandBuffer& out, const std::function<void(VkCommandBuffer)>& commands);
  // Records, submits and waits. Returns the first result that is not a success.
  VkResult run(const std::function<void(VkCommandBuffer)>& commands);
  // Binds and dispatches.
  VkResult dispatch(const ComputePipeline& pipeline, VkDescriptorSet set, std::array<uint32_t, 3> groups,
                    const std::vector<uint32_t>& push_constants = {});
  template <class Function>
  Function load(const char* name) const {
    return reinterpret_cast<Function>(vkGetDeviceProcAddr(device, name));
  }

  static constexpr VkBufferUsageFlags kAllUses =
      VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
      VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
      VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;

  VkInstance instance = nullptr;
  VkPhysicalDevice physical = nullptr;
  VkDevice device = nullptr;
  VkQueue queue = nullptr;
  VkCommandPool pool = nullptr;
  std::vector<std::string> messages;  // warnings and errors that the messenger heard
  std::string prints;                 // what it heard of the severity "info"

 private:
  void make_instance(const Options& options);
  void make_device(const Options& options);
  uint32_t host_memory_type() const;
  VkDeviceMemory allocate(const VkMemoryRequirements& needs, const void* more = nullptr);

  VkDebugUtilsMessengerEXT messenger_ = nullptr;
  std::vector<std::function<void()>> ends_;  // in the order of making
};

}  // namespace glint::test
