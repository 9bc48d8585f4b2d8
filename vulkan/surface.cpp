// Makes surfaces, and says what swapchains on them may be.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/surface.h"

#include <cstdint>

#include "vulkan/chain.h"
#include "vulkan/device.h"
#include "vulkan/image.h"
#include "vulkan/swapchain.h"
#include "vulkan/x_window.h"

namespace glint::vulkan {
namespace {

constexpr uint32_t kChosenBySwapchain = 0xffff'ffff;
constexpr VkPresentModeKHR kModes[] = {VK_PRESENT_MODE_FIFO_KHR, VK_PRESENT_MODE_MAILBOX_KHR,
                                       VK_PRESENT_MODE_IMMEDIATE_KHR};

Surface* surface_on(xcb_connection_t* connection, xcb_window_t window) {
  return new Surface{connection && can_ask_for_sizes() ? connection : nullptr, window};
}

VkSurfaceCapabilitiesKHR capabilities_of(const PhysicalDevice& device, const Surface& surface) {
  VkSurfaceCapabilitiesKHR out{};
  const uint32_t most = device.core.limits.maxImageDimension2D;
  const std::optional<VkExtent2D> size = size_of(surface);
  out.minImageCount = kFewestSwapchainImages, out.maxImageCount = kMostSwapchainImages;
  out.currentExtent = size.value_or(VkExtent2D{kChosenBySwapchain, kChosenBySwapchain});
  out.minImageExtent = size.value_or(VkExtent2D{1, 1}),
  out.maxImageExtent = size.value_or(VkExtent2D{most, most});
  out.maxImageArrayLayers = 1;
  out.supportedTransforms = out.currentTransform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
  out.supportedCompositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
  // Vulkan asks for colour attachments, and draws to them are dropped like all others.
  out.supportedUsageFlags = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                            VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                            VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
  return out;
}

VkSurfaceFormatKHR surface_format(uint32_t i) {
  return {kSurfaceFormats[i], VK_COLOR_SPACE_SRGB_NONLINEAR_KHR};
}

}  // namespace

std::optional<VkExtent2D> size_of(const Surface& surface) {
  if (!surface.connection) return std::nullopt;
  return size_of_window(surface.connection, surface.window);
}

VkResult CreateHeadlessSurfaceEXT(Instance&, const VkHeadlessSurfaceCreateInfoEXT*, VkSurfaceKHR* out) {
  *out = new Surface;
  return VK_SUCCESS;
}
VkResult CreateXcbSurfaceKHR(Instance&, const VkXcbSurfaceCreateInfoKHR* info, VkSurfaceKHR* out) {
  *out = surface_on(info->connection, info->window);
  return VK_SUCCESS;
}
VkResult CreateXlibSurfaceKHR(Instance&, const VkXlibSurfaceCreateInfoKHR* info, VkSurfaceKHR* out) {
  *out = surface_on(connection_of(info->dpy), xcb_window_t(info->window));
  return VK_SUCCESS;
}
void DestroySurfaceKHR(Instance&, VkSurfaceKHR surface) {
  if (surface && surface->swapchain) surface->swapchain->is_retired = true;
  delete surface;
}

// Pictures go into files, so every queue presents to every window.
VkBool32 GetPhysicalDeviceXcbPresentationSupportKHR(PhysicalDevice&, uint32_t, xcb_connection_t*,
                                                    xcb_visualid_t) {
  return VK_TRUE;
}
VkBool32 GetPhysicalDeviceXlibPresentationSupportKHR(PhysicalDevice&, uint32_t, Display*, VisualID) {
  return VK_TRUE;
}
VkResult GetPhysicalDeviceSurfaceSupportKHR(PhysicalDevice&, uint32_t, VkSurfaceKHR, VkBool32* out) {
  *out = VK_TRUE;
  return VK_SUCCESS;
}

VkResult GetPhysicalDeviceSurfaceCapabilitiesKHR(PhysicalDevice& device, VkSurfaceKHR surface,
                                                 VkSurfaceCapabilitiesKHR* out) {
  *out = capabilities_of(device, *surface);
  return VK_SUCCESS;
}
VkResult GetPhysicalDeviceSurfaceCapabilities2KHR(PhysicalDevice& device,
                                                  const VkPhysicalDeviceSurfaceInfo2KHR* info,
                                                  VkSurfaceCapabilities2KHR* out) {
  out->surfaceCapabilities = capabilities_of(device, *info->surface);
  return VK_SUCCESS;
}

VkResult GetPhysicalDeviceSurfaceFormatsKHR(PhysicalDevice&, VkSurfaceKHR, uint32_t* count,
                                            VkSurfaceFormatKHR* out) {
  return enumerate(uint32_t(kSurfaceFormats.size()), count, out,
                   [](auto& to, uint32_t i) { to = surface_format(i); });
}
VkResult GetPhysicalDeviceSurfaceFormats2KHR(PhysicalDevice&, const VkPhysicalDeviceSurfaceInfo2KHR*,
                                             uint32_t* count, VkSurfaceFormat2KHR* out) {
  return enumerate(uint32_t(kSurfaceFormats.size()), count, out,
                   [](auto& to, uint32_t i) { to.surfaceFormat = surface_format(i); });
}

VkResult GetPhysicalDeviceSurfacePresentModesKHR(PhysicalDevice&, VkSurfaceKHR, uint32_t* count,
                                                 VkPresentModeKHR* out) {
  return enumerate(uint32_t(std::size(kModes)), count, out, [](auto& to, uint32_t i) { to = kModes[i]; });
}

VkResult GetPhysicalDevicePresentRectanglesKHR(PhysicalDevice&, VkSurfaceKHR surface, uint32_t* count,
                                               VkRect2D* out) {
  const VkExtent2D size = size_of(*surface).value_or(VkExtent2D{kChosenBySwapchain, kChosenBySwapchain});
  return enumerate(1, count, out, [&](auto& to, uint32_t) { to = {{0, 0}, size}; });
}

}  // namespace glint::vulkan
