// Keeps numbers that applications and layers hang on objects.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <map>
#include <utility>

#include "vulkan/device.h"

struct VkPrivateDataSlot_T {
  std::map<std::pair<VkObjectType, uint64_t>, uint64_t> values;
};

namespace glint::vulkan {

VkResult CreatePrivateDataSlot(Device&, const VkPrivateDataSlotCreateInfo*, VkPrivateDataSlot* out) {
  *out = new VkPrivateDataSlot_T;
  return VK_SUCCESS;
}
void DestroyPrivateDataSlot(Device&, VkPrivateDataSlot slot) {
  delete slot;
}
VkResult SetPrivateData(Device&, VkObjectType type, uint64_t object, VkPrivateDataSlot slot, uint64_t value) {
  slot->values[{type, object}] = value;
  return VK_SUCCESS;
}
void GetPrivateData(Device&, VkObjectType type, uint64_t object, VkPrivateDataSlot slot, uint64_t* out) {
  const auto found = slot->values.find({type, object});
  *out = found == slot->values.end() ? 0 : found->second;
}

}  // namespace glint::vulkan
