// Looks for pixels that are not finite.
// SPDX-License-Identifier: Apache-2.0
#include "report/picture/not_finite.h"

#include <cmath>
#include <fmt/format.h>

#include "report/terminal/table.h"

namespace glint::report {

std::optional<NotFinite> not_finite(const pictures::ImageView& image) {
  NotFinite out;
  const size_t pixels = size_t{image.width} * image.height;
  for (size_t i = 0; i < pixels; ++i) {
    const float *const pixel = &image.rgba[4 * i], sum = pixel[0] + pixel[1] + pixel[2];
    // A finite sum has finite terms; the terms of another one may still be finite.
    if (std::isfinite(sum)) continue;
    if (std::isfinite(pixel[0]) && std::isfinite(pixel[1]) && std::isfinite(pixel[2])) continue;
    if (out.pixels++ > 0) continue;
    out.x = uint32_t(i % image.width);
    out.y = uint32_t(i / image.width);
    out.rgb = {pixel[0], pixel[1], pixel[2]};
  }
  return out.pixels > 0 ? std::optional(out) : std::nullopt;
}

std::string text_of(const NotFinite& found, const pictures::ImageView& image) {
  const std::string stored = found.stored_at.empty() ? "" : ", stored at " + found.stored_at;
  return fmt::format("{} of {} pixels are not finite; the first at x {}, y {} from the top left: {} {} {}{}",
                     with_thousands(found.pixels), with_thousands(uint64_t{image.width} * image.height),
                     found.x, found.y, found.rgb[0], found.rgb[1], found.rgb[2], stored);
}

}  // namespace glint::report
