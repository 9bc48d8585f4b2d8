// Runs what applications submit, in order.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "vulkan/handles.h"

struct VkQueue_T : glint::vulkan::Dispatchable {
  explicit VkQueue_T(VkDevice_T& of) : device(of) {}
  VkDevice_T& device;
};
