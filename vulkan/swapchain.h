// Holds swapchains: images that an application acquires, fills and presents.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "vulkan/surface.h"

// Its images are ordinary ones with memory of their own.
struct VkSwapchainKHR_T {
  enum class State : uint8_t { Free, Acquired, Presented };  // Presented: queued, and not yet shown
  struct Place {
    VkImage image = nullptr;
    VkDeviceMemory memory = nullptr;
    State state = State::Free;
  };

  VkSurfaceKHR surface = nullptr;
  VkExtent2D extent{};
  std::vector<Place> places;
  uint32_t next = 0;  // the image that is acquired next, if it is free
  bool is_retired = false;
};

namespace glint::vulkan {

using Swapchain = VkSwapchainKHR_T;

// Binds an image that was made for a swapchain to the memory of one of its images. Throws Refusal when there
// is no such image.
void bind_to_swapchain(Device& device, VkImage image, const VkBindImageMemorySwapchainInfoKHR& info);

}  // namespace glint::vulkan
