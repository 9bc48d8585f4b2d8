// Tests surfaces and swapchains, and is the program of window_test.py: frames that are cleared, or written by
// a dispatch, and presented.
// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <dlfcn.h>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <vector>

#include "tests/support/catch.h"
#include "tests/vulkan/client.h"
#include "vulkan/window_system.h"

namespace glint::test {
namespace {

constexpr VkExtent2D kScreenSize{40, 24};
constexpr uint64_t kForever = ~uint64_t{0};

// Is a client with a surface and a swapchain on it.
struct Screen {
  explicit Screen(VkExtent2D extent = kScreenSize, const char* kind = VK_EXT_HEADLESS_SURFACE_EXTENSION_NAME,
                  const std::function<VkSurfaceKHR(VkInstance)>& on = headless)
      : client({.extensions = {VK_KHR_SWAPCHAIN_EXTENSION_NAME},
                .instance_extensions = {VK_KHR_SURFACE_EXTENSION_NAME, kind}}),
        surface(on(client.instance)) {
    client.at_end([this] { vkDestroySurfaceKHR(client.instance, surface, nullptr); });
    chain = swapchain(extent);
  }

  static VkSurfaceKHR headless(VkInstance instance) {
    const VkHeadlessSurfaceCreateInfoEXT info{VK_STRUCTURE_TYPE_HEADLESS_SURFACE_CREATE_INFO_EXT, nullptr, 0};
    VkSurfaceKHR out = nullptr;
    check(reinterpret_cast<PFN_vkCreateHeadlessSurfaceEXT>(
              vkGetInstanceProcAddr(instance, "vkCreateHeadlessSurfaceEXT"))(instance, &info, nullptr, &out),
          "vkCreateHeadlessSurfaceEXT");
    return out;
  }

  VkSwapchainKHR swapchain(VkExtent2D extent, VkSwapchainKHR old = nullptr,
                           VkFormat format = VK_FORMAT_B8G8R8A8_UNORM) {
    VkSwapchainCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR, info.surface = surface;
    info.minImageCount = 3, info.imageFormat = format, info.imageExtent = extent;
    info.imageArrayLayers = 1, info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.preTransform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR, info.oldSwapchain = old;
    VkSwapchainKHR out = nullptr;
    result = vkCreateSwapchainKHR(client.device, &info, nullptr, &out);
    if (result != VK_SUCCESS) return nullptr;
    client.at_end([this, out] { vkDestroySwapchainKHR(client.device, out, nullptr); });
    images.resize(3);
    uint32_t count = 3;
    check(vkGetSwapchainImagesKHR(client.device, out, &count, images.data()), "vkGetSwapchainImagesKHR");
    return out;
  }

  VkSurfaceCapabilitiesKHR capabilities() {
    VkSurfaceCapabilitiesKHR out{};
    result = vkGetPhysicalDeviceSurfaceCapabilitiesKHR(client.physical, surface, &out);
    return out;
  }

  // Acquires an image. Keeps the result.
  uint32_t acquire(uint64_t timeout = kForever, VkSemaphore semaphore = nullptr, VkFence fence = nullptr) {
    uint32_t out = ~0u;
    result = vkAcquireNextImageKHR(client.device, chain, timeout, semaphore, fence, &out);
    return out;
  }
  VkResult present(uint32_t image, VkSemaphore wait = nullptr) {
    VkPresentInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
    info.waitSemaphoreCount = wait ? 1 : 0, info.pWaitSemaphores = &wait;
    info.swapchainCount = 1, info.pSwapchains = &chain, info.pImageIndices = &image;
    return vkQueuePresentKHR(client.queue, &info);
  }
  // Fills an image with red, green and blue of 0 to 1.
  void clear(uint32_t image, float red, float green, float blue) {
    const VkClearColorValue colour{{red, green, blue, 1}};
    const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    check(client.run([&](VkCommandBuffer commands) {
      vkCmdClearColorImage(commands, images[image], VK_IMAGE_LAYOUT_GENERAL, &colour, 1, &all);
    }),
          "the clear");
  }
  VkSemaphore semaphore() {
    const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, nullptr, 0};
    VkSemaphore out = nullptr;
    check(vkCreateSemaphore(client.device, &info, nullptr, &out), "vkCreateSemaphore");
    client.at_end([this, out] { vkDestroySemaphore(client.device, out, nullptr); });
    return out;
  }

  Client client;
  VkSurfaceKHR surface;
  std::vector<VkImage> images;
  VkResult result = VK_SUCCESS;
  VkSwapchainKHR chain = nullptr;
};

TEST_CASE("a headless surface leaves the size to the swapchain and has the usual formats") {
  Screen screen;
  const VkSurfaceCapabilitiesKHR can = screen.capabilities();
  CHECK(can.currentExtent.width == 0xffff'ffff);
  CHECK((can.supportedUsageFlags & VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT) != 0);
  CHECK(can.minImageCount <= 3);
  uint32_t count = 0;
  REQUIRE(vkGetPhysicalDeviceSurfaceFormatsKHR(screen.client.physical, screen.surface, &count, nullptr) ==
          VK_SUCCESS);
  std::vector<VkSurfaceFormatKHR> formats(count);
  vkGetPhysicalDeviceSurfaceFormatsKHR(screen.client.physical, screen.surface, &count, formats.data());
  CHECK(formats.at(0).format == VK_FORMAT_B8G8R8A8_UNORM);
  VkBool32 is_supported = VK_FALSE;
  vkGetPhysicalDeviceSurfaceSupportKHR(screen.client.physical, 0, screen.surface, &is_supported);
  CHECK(is_supported == VK_TRUE);
}

TEST_CASE("images are acquired one after another, and none twice before it is presented") {
  Screen screen;
  for (uint32_t i = 0; i < 3; ++i) CHECK(screen.acquire() == i);
  screen.acquire(0);
  CHECK(screen.result == VK_NOT_READY);
  screen.acquire(1000);
  CHECK(screen.result == VK_TIMEOUT);
  screen.acquire(kForever);
  CHECK(screen.result < 0);  // A wait that nothing ends is refused.
  CHECK(screen.present(1) == VK_SUCCESS);
  CHECK(screen.acquire() == 1);
  CHECK(screen.present(1) == VK_SUCCESS);
  CHECK(screen.present(1) < 0);  // It is not acquired.
}

TEST_CASE("an acquire signals its semaphore and its fence, and a present waits for its own") {
  Screen screen;
  const VkSemaphore acquired = screen.semaphore(), drawn = screen.semaphore();
  const VkSemaphore host = screen.client.timeline(0);
  const VkFence fence = screen.client.fence();
  const uint32_t image = screen.acquire(kForever, acquired, fence);
  CHECK(vkGetFenceStatus(screen.client.device, fence) == VK_SUCCESS);

  // The submission waits for the host, and the present for the submission: the image stays taken.
  const VkSemaphore waits[] = {acquired, host};
  const uint64_t values[] = {0, 5};
  const VkTimelineSemaphoreSubmitInfo timeline{
      VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO, nullptr, 2, values, 0, nullptr};
  const VkPipelineStageFlags stages[] = {VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT};
  const VkSubmitInfo submit{
      VK_STRUCTURE_TYPE_SUBMIT_INFO, &timeline, 2, waits, stages, 0, nullptr, 1, &drawn};
  REQUIRE(vkQueueSubmit(screen.client.queue, 1, &submit, nullptr) == VK_SUCCESS);
  REQUIRE(screen.present(image, drawn) == VK_SUCCESS);
  CHECK(screen.acquire() == 1);
  CHECK(screen.acquire() == 2);
  screen.acquire(0);
  CHECK(screen.result == VK_NOT_READY);
  const VkSemaphoreSignalInfo signal{VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO, nullptr, host, 5};
  REQUIRE(vkSignalSemaphore(screen.client.device, &signal) == VK_SUCCESS);
  CHECK(screen.acquire(0) == image);
}

TEST_CASE("a swapchain that another one replaced is out of date, and a surface has one") {
  Screen screen;
  const uint32_t image = screen.acquire();
  const VkSwapchainKHR old = screen.chain;
  CHECK(screen.swapchain(kScreenSize) == nullptr);
  CHECK(screen.result == VK_ERROR_NATIVE_WINDOW_IN_USE_KHR);
  const VkSwapchainKHR next = screen.swapchain({8, 8}, old);
  REQUIRE(next);
  screen.acquire();
  CHECK(screen.result == VK_ERROR_OUT_OF_DATE_KHR);
  CHECK(screen.present(image) == VK_ERROR_OUT_OF_DATE_KHR);
  screen.chain = next;
  CHECK(screen.acquire() == 0);
  CHECK(screen.swapchain({8, 8}, next, VK_FORMAT_R32_SFLOAT) == nullptr);
  CHECK(screen.swapchain({0, 8}, next) == nullptr);
}

TEST_CASE("a clear in red, one in green and one in blue are presented", "[.][three_frames]") {
  Screen screen;
  const MappedBuffer out = screen.client.buffer(4096);
  const ComputePipeline add = screen.client.pipeline(
      "#version 460\nlayout(local_size_x = 64) in;\nlayout(set = 0, binding = 0) buffer A { uint a[]; };\n"
      "void main() { a[gl_GlobalInvocationID.x] += 3; }\n",
      {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}});
  const VkDescriptorSet set = screen.client.set(add.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});
  for (int frame = 0; frame < 3; ++frame) {
    const uint32_t image = screen.acquire();
    REQUIRE(screen.client.dispatch(add, set, {1, 1, 1}) == VK_SUCCESS);
    screen.clear(image, frame == 0 ? 1.0f : 0, frame == 1 ? 1.0f : 0, frame == 2 ? 1.0f : 0);
    REQUIRE(screen.present(image) == VK_SUCCESS);
  }
  std::cout << screen.client.prints;
}

// Is a window of Xlib on the server that DISPLAY names, 200 by 120 pixels.
class XlibWindow {
 public:
  XlibWindow() {
    library_ = dlopen("libX11.so.6", RTLD_NOW);
    if (!library_) throw std::runtime_error("libX11 is not installed");
    display = function<Display* (*)(const char*)>("XOpenDisplay")(nullptr);
    if (!display) throw std::runtime_error("no X server answers");
    const Window root = function<Window (*)(Display*)>("XDefaultRootWindow")(display);
    window =
        function<Window (*)(Display*, Window, int, int, unsigned, unsigned, unsigned, unsigned long,
                            unsigned long)>("XCreateSimpleWindow")(display, root, 0, 0, 200, 120, 0, 0, 0);
    synchronize();
  }
  ~XlibWindow() { function<int (*)(Display*)>("XCloseDisplay")(display); }

  void resize(unsigned width, unsigned height) const {
    function<int (*)(Display*, Window, unsigned, unsigned)>("XResizeWindow")(display, window, width, height);
    synchronize();
  }
  void destroy() const {
    function<int (*)(Display*, Window)>("XDestroyWindow")(display, window);
    synchronize();
  }
  VkSurfaceKHR surface(VkInstance instance) const {
    const VkXlibSurfaceCreateInfoKHR info{VK_STRUCTURE_TYPE_XLIB_SURFACE_CREATE_INFO_KHR, nullptr, 0, display,
                                          window};
    VkSurfaceKHR out = nullptr;
    check(reinterpret_cast<PFN_vkCreateXlibSurfaceKHR>(
              vkGetInstanceProcAddr(instance, "vkCreateXlibSurfaceKHR"))(instance, &info, nullptr, &out),
          "vkCreateXlibSurfaceKHR");
    return out;
  }

  Display* display = nullptr;
  Window window = 0;

 private:
  template <class Function>
  Function function(const char* name) const {
    return reinterpret_cast<Function>(dlsym(library_, name));
  }
  // The server has done all that was asked when it answers.
  void synchronize() const { function<int (*)(Display*, int)>("XSync")(display, 0); }

  void* library_ = nullptr;
};

// It needs an X server.
TEST_CASE("a window of Xlib gives its size, and is lost when it is destroyed", "[.][xlib]") {
  const XlibWindow window;
  Screen screen({200, 120}, VK_KHR_XLIB_SURFACE_EXTENSION_NAME,
                [&](VkInstance instance) { return window.surface(instance); });
  CHECK(screen.capabilities().currentExtent.width == 200);
  CHECK(screen.capabilities().currentExtent.height == 120);
  const uint32_t image = screen.acquire();
  screen.clear(image, 0, 1, 0);
  REQUIRE(screen.present(image) == VK_SUCCESS);

  window.resize(300, 100);
  CHECK(screen.capabilities().currentExtent.width == 300);
  screen.acquire();
  CHECK(screen.result == VK_SUBOPTIMAL_KHR);
  window.destroy();
  screen.capabilities();
  CHECK(screen.result == VK_ERROR_SURFACE_LOST_KHR);
}

// The driver looks at no stage of a graphics pipeline, so this one has none.
VkPipeline graphics_pipeline(Client& client, VkRenderPass pass) {
  VkGraphicsPipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, info.renderPass = pass;
  VkPipeline out = nullptr;
  check(vkCreateGraphicsPipelines(client.device, nullptr, 1, &info, nullptr, &out),
        "vkCreateGraphicsPipelines");
  client.at_end([&client, out] { vkDestroyPipeline(client.device, out, nullptr); });
  return out;
}

VkRenderPass clearing_pass(Client& client) {
  VkAttachmentDescription attachment{};
  attachment.format = VK_FORMAT_B8G8R8A8_UNORM, attachment.samples = VK_SAMPLE_COUNT_1_BIT;
  attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  const VkAttachmentReference colour{0, VK_IMAGE_LAYOUT_GENERAL};
  VkSubpassDescription subpass{};
  subpass.colorAttachmentCount = 1, subpass.pColorAttachments = &colour;
  VkRenderPassCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
  info.attachmentCount = info.subpassCount = 1;
  info.pAttachments = &attachment, info.pSubpasses = &subpass;
  VkRenderPass out = nullptr;
  check(vkCreateRenderPass(client.device, &info, nullptr, &out), "vkCreateRenderPass");
  client.at_end([&client, out] { vkDestroyRenderPass(client.device, out, nullptr); });
  return out;
}

VkImageView colour_view_of(Client& client, VkImage image) {
  VkImageViewCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, info.image = image;
  info.viewType = VK_IMAGE_VIEW_TYPE_2D, info.format = VK_FORMAT_B8G8R8A8_UNORM;
  info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  VkImageView out = nullptr;
  check(vkCreateImageView(client.device, &info, nullptr, &out), "vkCreateImageView");
  client.at_end([&client, out] { vkDestroyImageView(client.device, out, nullptr); });
  return out;
}

// It needs GLINT_VK_QUEUE=universal.
TEST_CASE("a device with a universal queue has formats of vertices", "[.][vertex_formats]") {
  Client client;
  for (const VkFormat each :
       {VK_FORMAT_R32G32B32_SFLOAT, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32_SINT, VK_FORMAT_R8G8B8A8_UNORM}) {
    VkFormatProperties can;
    vkGetPhysicalDeviceFormatProperties(client.physical, each, &can);
    CHECK((can.bufferFeatures & VK_FORMAT_FEATURE_VERTEX_BUFFER_BIT) != 0);
  }
  VkFormatProperties can;
  vkGetPhysicalDeviceFormatProperties(client.physical, VK_FORMAT_D32_SFLOAT, &can);
  CHECK((can.bufferFeatures & VK_FORMAT_FEATURE_VERTEX_BUFFER_BIT) == 0);
}

// It needs GLINT_VK_QUEUE=universal.
TEST_CASE("a universal device has families for computing and for copies alone", "[.][families]") {
  Client client;
  std::vector<VkQueueFamilyProperties> families(9);
  auto count = uint32_t(families.size());
  vkGetPhysicalDeviceQueueFamilyProperties(client.physical, &count, families.data());
  REQUIRE(count == 3);
  CHECK(families[0].queueFlags == (VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT));
  CHECK(families[1].queueFlags == (VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT));
  CHECK(families[2].queueFlags == VK_QUEUE_TRANSFER_BIT);
  const float priorities[4] = {1, 1, 1, 1};
  std::vector<VkDeviceQueueCreateInfo> wanted;
  for (uint32_t i = 0; i < count; ++i)
    wanted.push_back({VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, i, 4, priorities});
  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.queueCreateInfoCount = count, info.pQueueCreateInfos = wanted.data();
  VkDevice device = nullptr;
  REQUIRE(vkCreateDevice(client.physical, &info, nullptr, &device) == VK_SUCCESS);
  std::set<VkQueue> queues;
  for (uint32_t i = 0; i < 12; ++i) {
    VkQueue queue = nullptr;
    vkGetDeviceQueue(device, i / 4, i % 4, &queue);
    queues.insert(queue);
    CHECK(vkQueueWaitIdle(queue) == VK_SUCCESS);
  }
  CHECK(queues.size() == 12);
  vkDestroyDevice(device, nullptr);
}

// It needs GLINT_VK_QUEUE=universal.
TEST_CASE("a pass that clears to blue, clears a part to green, and draws in vain", "[.][dropped_draws]") {
  Screen screen;
  Client& client = screen.client;
  const uint32_t image = screen.acquire();
  const VkRenderPass pass = clearing_pass(client);
  const VkPipeline pipeline = graphics_pipeline(client, pass);
  const VkImageView view = colour_view_of(client, screen.images[image]);
  VkFramebufferCreateInfo framebuffer{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                      nullptr,
                                      0,
                                      pass,
                                      1,
                                      &view,
                                      kScreenSize.width,
                                      kScreenSize.height,
                                      1};
  VkFramebuffer target = nullptr;
  check(vkCreateFramebuffer(client.device, &framebuffer, nullptr, &target), "vkCreateFramebuffer");
  client.at_end([&client, target] { vkDestroyFramebuffer(client.device, target, nullptr); });

  VkClearValue blue{}, green{};
  blue.color = {{0, 0, 1, 1}}, green.color = {{0, 1, 0, 1}};
  const VkRenderPassBeginInfo begin{
      VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO, nullptr, pass, target, {{}, kScreenSize}, 1, &blue};
  const VkClearAttachment part{VK_IMAGE_ASPECT_COLOR_BIT, 0, green};
  const VkClearRect where{{{0, 4}, {kScreenSize.width, 4}}, 0, 1};
  REQUIRE(client.run([&](VkCommandBuffer commands) {
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdClearAttachments(commands, 1, &part, 1, &where);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdDrawIndexed(commands, 3, 1, 0, 0, 0);
    vkCmdEndRenderPass(commands);
  }) == VK_SUCCESS);
  REQUIRE(screen.present(image) == VK_SUCCESS);
}

}  // namespace
}  // namespace glint::test
