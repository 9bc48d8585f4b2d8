// Holds surfaces: windows of the application, or nothing at all, to which swapchains present.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "vulkan/handles.h"

// Nobody looks at a window of X: the driver asks for its size and draws nothing there.
struct VkSurfaceKHR_T {
  xcb_connection_t* connection = nullptr;  // null: there is no window, or nobody can ask for its size
  xcb_window_t window = 0;
  VkSwapchainKHR swapchain = nullptr;  // the one that presents to the surface and is not retired
};

namespace glint::vulkan {

using Surface = VkSurfaceKHR_T;

inline constexpr uint32_t kFewestSwapchainImages = 2, kMostSwapchainImages = 16;
inline constexpr std::array kSurfaceFormats{VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_B8G8R8A8_SRGB,
                                            VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB};

// Returns the size of the surface's window, or nothing when the swapchain chooses the size. Throws Refusal
// when the window is gone.
std::optional<VkExtent2D> size_of(const Surface& surface);

}  // namespace glint::vulkan
