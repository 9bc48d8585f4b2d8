// Makes swapchains, and lets applications acquire and present their images.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/swapchain.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <memory>
#include <optional>
#include <utility>

#include "vulkan/chain.h"
#include "vulkan/device.h"
#include "vulkan/frames.h"
#include "vulkan/image.h"
#include "vulkan/memory.h"
#include "vulkan/sync.h"

namespace glint::vulkan {
namespace {

using State = Swapchain::State;

void add_image(Device& device, Swapchain& chain, const VkSwapchainCreateInfoKHR& info) {
  VkImageCreateInfo image{};
  image.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO, image.imageType = VK_IMAGE_TYPE_2D;
  image.format = info.imageFormat;
  image.extent = {info.imageExtent.width, info.imageExtent.height, 1};
  image.mipLevels = image.arrayLayers = 1, image.samples = VK_SAMPLE_COUNT_1_BIT;
  image.usage = info.imageUsage;
  Swapchain::Place& out = chain.places.emplace_back();
  CreateImage(device, &image, &out.image);
  const VkMemoryAllocateInfo memory{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr,
                                    requirements_of(out.image->whole.bytes()).size, 0};
  AllocateMemory(device, &memory, &out.memory);
  BindImageMemory(device, out.image, out.memory, 0);
}

void end(Device& device, Swapchain* chain) {
  for (const Swapchain::Place& each : chain->places) {
    DestroyImage(device, each.image);
    FreeMemory(device, each.memory);
  }
  delete chain;
}

void check(const Device& device, const VkSwapchainCreateInfoKHR& info) {
  const auto& formats = kSurfaceFormats;
  const uint32_t most = device.physical.core.limits.maxImageDimension2D;
  if (std::find(formats.begin(), formats.end(), info.imageFormat) == formats.end())
    throw Refusal(VK_ERROR_FORMAT_NOT_SUPPORTED,
                  fmt::format("surfaces have no format {}", int(info.imageFormat)));
  if (!info.imageExtent.width || !info.imageExtent.height || info.imageExtent.width > most ||
      info.imageExtent.height > most)
    throw Refusal(VK_ERROR_INITIALIZATION_FAILED,
                  fmt::format("a swapchain of {} x {} pixels: each may be 1 to {}", info.imageExtent.width,
                              info.imageExtent.height, most));
  if (info.minImageCount > kMostSwapchainImages)
    throw Refusal(VK_ERROR_INITIALIZATION_FAILED, fmt::format("a swapchain of {} images: it may have {}",
                                                              info.minImageCount, kMostSwapchainImages));
  if (info.imageArrayLayers > 1) throw Refusal("images of a swapchain have one layer");
  if (info.surface->swapchain && info.surface->swapchain != info.oldSwapchain)
    throw Refusal(VK_ERROR_NATIVE_WINDOW_IN_USE_KHR, "the surface has a swapchain already");
}

// Choice: a window whose size has changed still shows nothing, so its swapchain goes on and is suboptimal.
VkResult result_of(const Swapchain& chain) {
  try {
    const VkExtent2D size = size_of(*chain.surface).value_or(chain.extent);
    const bool fits = size.width == chain.extent.width && size.height == chain.extent.height;
    return fits ? VK_SUCCESS : VK_SUBOPTIMAL_KHR;
  } catch (const Refusal& refusal) {
    return refusal.result();
  }
}

// Returns the image after the one that was acquired last which is free, or nothing.
std::optional<uint32_t> free_image(const Swapchain& chain) {
  for (uint32_t i = 0; i < chain.places.size(); ++i)
    if (const uint32_t at = (chain.next + i) % uint32_t(chain.places.size());
        chain.places[at].state == State::Free)
      return at;
  return std::nullopt;
}

VkResult acquire(Device& device, Swapchain& chain, uint64_t nanoseconds, VkSemaphore semaphore, VkFence fence,
                 uint32_t* out) {
  if (device.is_lost) return VK_ERROR_DEVICE_LOST;
  if (chain.is_retired) return VK_ERROR_OUT_OF_DATE_KHR;
  const VkResult result = result_of(chain);
  if (result < 0) return result;
  device.advance();
  std::optional<uint32_t> found = free_image(chain);
  constexpr uint64_t kLongest = uint64_t{1} << 55;  // A wait of more than a year has no end.
  if (!found && nanoseconds > kLongest)
    throw Refusal(
        fmt::format("all {} images of a swapchain are acquired or wait for their semaphores, and "
                    "another one is waited for without an end",
                    chain.places.size()));
  if (!found && nanoseconds)
    device.changed.wait_for(device.mutex, std::chrono::nanoseconds(nanoseconds),
                            [&] { return device.is_lost || (found = free_image(chain)).has_value(); });
  if (device.is_lost) return VK_ERROR_DEVICE_LOST;
  if (!found) return nanoseconds ? VK_TIMEOUT : VK_NOT_READY;
  chain.places[*found].state = State::Acquired;
  chain.next = (*found + 1) % uint32_t(chain.places.size());
  *out = *found;
  if (semaphore) semaphore->value = 1;
  if (fence) fence->is_signaled = true;
  device.advance();
  return result;
}

// Returns the images that a present shows. Throws Refusal when one of them was not acquired.
std::vector<Swapchain::Place*> shown_by(const VkPresentInfoKHR& info) {
  std::vector<Swapchain::Place*> out;
  for (uint32_t i = 0; i < info.swapchainCount; ++i) {
    Swapchain& chain = *info.pSwapchains[i];
    const uint32_t at = info.pImageIndices[i];
    if (at >= chain.places.size() || chain.places[at].state != State::Acquired)
      throw Refusal(fmt::format("image {} of a swapchain is presented and was not acquired", at));
    out.push_back(&chain.places[at]);
  }
  return out;
}

}  // namespace

void bind_to_swapchain(Device& device, VkImage image, const VkBindImageMemorySwapchainInfoKHR& info) {
  if (info.imageIndex >= info.swapchain->places.size())
    throw Refusal(fmt::format("a swapchain of {} images has no image {}", info.swapchain->places.size(),
                              info.imageIndex));
  BindImageMemory(device, image, info.swapchain->places[info.imageIndex].memory, 0);
}

VkResult CreateSwapchainKHR(Device& device, const VkSwapchainCreateInfoKHR* info, VkSwapchainKHR* out) {
  check(device, *info);
  if (info->oldSwapchain) info->oldSwapchain->is_retired = true;
  if (info->surface->swapchain == info->oldSwapchain) info->surface->swapchain = nullptr;
  const auto end_it = [&device](Swapchain* chain) { end(device, chain); };
  std::unique_ptr<Swapchain, decltype(end_it)> made(new Swapchain, end_it);
  made->surface = info->surface, made->extent = info->imageExtent;
  for (uint32_t i = 0; i < std::max(info->minImageCount, kFewestSwapchainImages); ++i)
    add_image(device, *made, *info);
  *out = info->surface->swapchain = made.release();
  return VK_SUCCESS;
}

void DestroySwapchainKHR(Device& device, VkSwapchainKHR chain) {
  if (!chain) return;
  // A retired swapchain may live longer than its surface.
  if (!chain->is_retired && chain->surface->swapchain == chain) chain->surface->swapchain = nullptr;
  end(device, chain);
}

VkResult GetSwapchainImagesKHR(Device&, VkSwapchainKHR chain, uint32_t* count, VkImage* out) {
  return enumerate(uint32_t(chain->places.size()), count, out,
                   [&](auto& to, uint32_t i) { to = chain->places[i].image; });
}

VkResult AcquireNextImageKHR(Device& device, VkSwapchainKHR chain, uint64_t nanoseconds,
                             VkSemaphore semaphore, VkFence fence, uint32_t* out) {
  return acquire(device, *chain, nanoseconds, semaphore, fence, out);
}
VkResult AcquireNextImage2KHR(Device& device, const VkAcquireNextImageInfoKHR* info, uint32_t* out) {
  return acquire(device, *info->swapchain, info->timeout, info->semaphore, info->fence, out);
}

// A present waits in the queue like any other submission. It shows its images even where a window is gone.
VkResult QueuePresentKHR(Queue& queue, const VkPresentInfoKHR* info) {
  if (queue.device.is_lost) return VK_ERROR_DEVICE_LOST;
  const std::vector<Swapchain::Place*> shown = shown_by(*info);
  Submission submission;
  for (uint32_t i = 0; i < info->waitSemaphoreCount; ++i)
    submission.waits.push_back({info->pWaitSemaphores[i], 0});
  VkResult all = VK_SUCCESS;
  for (uint32_t i = 0; i < info->swapchainCount; ++i) {
    shown[i]->state = State::Presented;
    const Swapchain& chain = *info->pSwapchains[i];
    const VkResult result = chain.is_retired ? VK_ERROR_OUT_OF_DATE_KHR : result_of(chain);
    if (info->pResults) info->pResults[i] = result;
    if (all >= 0 && result != VK_SUCCESS) all = result;
  }
  submission.commands.push_back(std::make_shared<const Command>([shown](Queue& on) {
    std::vector<VkImage> images;
    for (Swapchain::Place* const each : shown) images.push_back(each->image), each->state = State::Free;
    present(on.device, images);
    return true;
  }));
  queue.submit(std::move(submission));
  queue.device.advance();
  return all;
}

VkResult GetDeviceGroupPresentCapabilitiesKHR(Device&, VkDeviceGroupPresentCapabilitiesKHR* out) {
  std::fill(std::begin(out->presentMask), std::end(out->presentMask), 0u);
  out->presentMask[0] = 1;
  out->modes = VK_DEVICE_GROUP_PRESENT_MODE_LOCAL_BIT_KHR;
  return VK_SUCCESS;
}
VkResult GetDeviceGroupSurfacePresentModesKHR(Device&, VkSurfaceKHR, VkDeviceGroupPresentModeFlagsKHR* out) {
  *out = VK_DEVICE_GROUP_PRESENT_MODE_LOCAL_BIT_KHR;
  return VK_SUCCESS;
}

}  // namespace glint::vulkan
