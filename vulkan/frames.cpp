// Counts the frames that an application presents, and makes pictures of those that the user wants.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/frames.h"

#include <algorithm>
#include <cstddef>
#include <fmt/format.h>
#include <utility>

#include "base/diagnostics.h"
#include "vulkan/device.h"
#include "vulkan/image.h"

namespace glint::vulkan {
namespace {

// Copies what an image shows. Its four channels have 8 bits, and a screen ignores the last one.
ShownImage shown(const Device& device, const VkImage_T& image) {
  const exec::ImageView& whole = image.whole;
  const bool is_bgra =
      whole.format == exec::TexelFormat::Bgra8Unorm || whole.format == exec::TexelFormat::Bgra8Srgb;
  const auto* from = reinterpret_cast<const uint8_t*>(texel_of(device, image, {}));
  ShownImage out{whole.width, whole.height, {}};
  out.rgb.reserve(size_t{3} * whole.width * whole.height);
  for (size_t i = 0; i < size_t{whole.width} * whole.height; ++i, from += 4)
    for (const size_t channel : {0, 1, 2}) out.rgb.push_back(from[is_bgra ? 2 - channel : channel]);
  return out;
}

}  // namespace

PictureChoice PictureChoice::parse(const std::string& text, const std::string& variable) {
  PictureChoice out;
  constexpr std::string_view kFrame = "frame ";
  if (text.empty() || text == "last")
    out.last_ = true;
  else if (text == "all")
    out.all_ = true;
  else if (text.starts_with(kFrame))
    out.frames_ = setup::NumberList::parse(text.substr(kFrame.size()), variable);
  else if (text != "none")
    throw UserError(
        fmt::format("{}: '{}' is none of 'all', 'last', 'none' and 'frame 0,7-9'", variable, text));
  return out;
}

void present(Device& device, const std::vector<VkImage>& images) {
  const uint64_t frame = device.frames++;
  const PictureChoice& choice = device.physical.instance.settings.pictures;
  const bool is_shown = device.recording.is_on() && (choice.keeps_last() || choice.takes(frame));
  std::vector<ShownImage> all;
  for (const VkImage each : images)
    if (is_shown) all.push_back(shown(device, *each));
  const VkExtent2D size =
      images.empty() ? VkExtent2D{} : VkExtent2D{images[0]->whole.width, images[0]->whole.height};
  device.recording.add_frame(frame, size, std::move(all));
}

}  // namespace glint::vulkan
