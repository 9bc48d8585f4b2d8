// Makes deferred operations. What may be deferred is done at once, so nothing is ever left to join.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/acceleration_structure.h"
#include "vulkan/device.h"

struct VkDeferredOperationKHR_T {};

namespace glint::vulkan {

VkResult done_at_once(VkDeferredOperationKHR operation) {
  return operation ? VK_OPERATION_NOT_DEFERRED_KHR : VK_SUCCESS;
}

VkResult CreateDeferredOperationKHR(Device&, VkDeferredOperationKHR* out) {
  *out = new VkDeferredOperationKHR_T;
  return VK_SUCCESS;
}
void DestroyDeferredOperationKHR(Device&, VkDeferredOperationKHR operation) {
  delete operation;
}
uint32_t GetDeferredOperationMaxConcurrencyKHR(Device&, VkDeferredOperationKHR) {
  return 0;  // It is complete.
}
VkResult GetDeferredOperationResultKHR(Device&, VkDeferredOperationKHR) {
  return VK_SUCCESS;
}
VkResult DeferredOperationJoinKHR(Device&, VkDeferredOperationKHR) {
  return VK_SUCCESS;
}

}  // namespace glint::vulkan
