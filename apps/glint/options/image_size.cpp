// Reads sizes and windows of pictures.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/image_size.h"

#include <array>
#include <cstdint>
#include <fmt/format.h>
#include <sstream>

#include "base/diagnostics.h"

namespace glint::app {
namespace {
using scenes::kMaxSide;

uint32_t number(const std::string& digits) {
  if (digits.empty() || digits.size() > 5 || digits.find_first_not_of("0123456789") != std::string::npos)
    return 0;
  return uint32_t(std::stoul(digits));
}
}  // namespace

void parse_size(const std::string& text, scenes::RenderParams& frame) {
  const size_t x = text.find('x');
  frame.width = number(text.substr(0, x));
  frame.height = x == std::string::npos ? 0 : number(text.substr(x + 1));
  if (frame.width < 1 || frame.height < 1 || frame.width > kMaxSide || frame.height > kMaxSide)
    throw UserError({}, fmt::format("--size is '{}', expected WIDTHxHEIGHT, each 1 to {}", text, kMaxSide),
                    "for example --size 128x128");
}

void parse_crop(const std::string& text, scenes::RenderParams& frame) {
  if (text.empty()) return;
  std::array<uint32_t, 4> window{};
  std::istringstream in(text);
  std::string digits;
  size_t found = 0;
  bool is_window = text.back() != ',';
  while (std::getline(in, digits, ',')) {
    const bool is_place = found < 2;  // A place may be 0, and a size may not.
    if (found < window.size()) window[found] = number(digits);
    is_window = is_window && found < window.size() &&
                (window[found] > 0 ||
                 (is_place && !digits.empty() && digits.find_first_not_of('0') == std::string::npos));
    ++found;
  }
  const auto [x, y, width, height] = window;
  if (!is_window || found != window.size())
    throw UserError({}, fmt::format("--crop is '{}', expected X,Y,WIDTH,HEIGHT in pixels", text),
                    "for example --crop 32,16,64,64; X and Y count from the top left");
  if (x + width > frame.width || y + height > frame.height)
    throw UserError({},
                    fmt::format("--crop is '{}', and that leaves the frame of {}x{} pixels", text,
                                frame.width, frame.height),
                    "--size gives the size of the whole frame");
  frame.frame_width = frame.width, frame.frame_height = frame.height;
  frame.crop_x = x, frame.crop_y = y;
  frame.width = width, frame.height = height;
}

}  // namespace glint::app
