// Gives Vulkan's handles the names of the objects that they point to.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vulkan/vk_icd.h>

#include "vulkan/window_system.h"

// A handle is a pointer to an opaque structure, such as VkBuffer_T, and the driver defines these structures.
// So a handle of the application is an object of the driver without a cast.
namespace glint::vulkan {

using Instance = VkInstance_T;
using PhysicalDevice = VkPhysicalDevice_T;
using Device = VkDevice_T;
using Queue = VkQueue_T;
using CommandBuffer = VkCommandBuffer_T;

// Comes first in each object that the loader knows: the loader keeps its own pointer there.
struct Dispatchable {
  Dispatchable() { set_loader_magic_value(this); }
  Dispatchable(const Dispatchable&) = delete;
  Dispatchable& operator=(const Dispatchable&) = delete;

 private:
  VK_LOADER_DATA loader_{};
};

}  // namespace glint::vulkan
