// Draws a map of cost: colours alone, and with name, scale and unit.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

#include "pictures/encode.h"
#include "report/files/heat_files.h"
#include "report/picture/colour_map.h"

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#endif
#include <stb_easy_font.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace glint::report {
namespace {

using Rgb = ColourMap::Rgb;
constexpr uint32_t kMostPixels = 2048;   // most pixels on a side of a picture
constexpr uint32_t kWantedPixels = 512;  // pixels on the longer side to which small maps are enlarged
constexpr int kFontScale = 2, kLine = 12 * kFontScale, kMargin = 16, kBar = 22, kTick = 6;

class Canvas {
 public:
  Canvas(int width, int height, Rgb paper)
      : width_(width), height_(height), pixels_(size_t(width) * size_t(height), paper) {}

  void fill(int x, int y, int width, int height, Rgb colour) {
    for (int row = std::max(y, 0); row < std::min(y + height, height_); ++row)
      for (int column = std::max(x, 0); column < std::min(x + width, width_); ++column)
        pixels_[size_t(row) * size_t(width_) + size_t(column)] = colour;
  }
  // Writes ASCII text with its upper left corner at (x, y).
  void write(int x, int y, std::string text, Rgb ink) {
    struct Vertex {
      float x, y, z;
      unsigned char colour[4];
    };
    std::vector<Vertex> corners(text.size() * 64 + 64);
    const int quads =
        stb_easy_font_print(0, 0, text.data(), nullptr, corners.data(), int(corners.size() * sizeof(Vertex)));
    for (int q = 0; q < quads; ++q) {
      const Vertex &from = corners[size_t(q) * 4], &to = corners[size_t(q) * 4 + 2];
      fill(x + int(from.x) * kFontScale, y + int(from.y) * kFontScale, int(to.x - from.x) * kFontScale,
           int(to.y - from.y) * kFontScale, ink);
    }
  }
  static int text_width(std::string text) { return stb_easy_font_width(text.data()) * kFontScale; }

  std::string png() const {
    std::vector<float> rgba;
    rgba.reserve(pixels_.size() * 4);
    for (const Rgb& pixel : pixels_) {
      for (const uint8_t part : pixel) rgba.push_back(float(part) / 255.0f);
      rgba.push_back(1.0f);
    }
    return pictures::png_bytes({uint32_t(width_), uint32_t(height_), rgba});
  }

 private:
  int width_, height_;
  std::vector<Rgb> pixels_;
};

// Returns a map with at most kMostPixels on a side. Pixels that share one are averaged.
CostMap reduced(const CostMap& map) {
  const uint32_t step_x = (map.width + kMostPixels - 1) / kMostPixels,
                 step_y = (map.height + kMostPixels - 1) / kMostPixels;
  if (step_x <= 1 && step_y <= 1) return map;
  CostMap out = map;
  out.width = (map.width + step_x - 1) / step_x;
  out.height = (map.height + step_y - 1) / step_y;
  out.values.assign(size_t{out.width} * out.height, 0.0);
  std::vector<uint32_t> count(out.values.size());
  for (size_t i = 0; i < map.values.size(); ++i) {
    const size_t at = i / map.width / step_y * out.width + i % map.width / step_x;
    out.values[at] += map.values[i];
    ++count[at];
  }
  for (size_t i = 0; i < out.values.size(); ++i) out.values[i] /= count[i];
  return out;
}

void draw_map(Canvas& canvas, const CostMap& map, double top, int x, int y, int scale_x, int scale_y) {
  const ColourMap colours;
  for (uint32_t row = 0; row < map.height; ++row)
    for (uint32_t column = 0; column < map.width; ++column) {
      const double value = map.values[size_t{row} * map.width + column];
      canvas.fill(x + int(column) * scale_x, y + int(row) * scale_y, scale_x, scale_y,
                  colours.of(top > 0 ? value / top : 0.0));
    }
}

// Writes a number with four digits at most, and with k, M or G.
std::string short_number(double value) {
  constexpr const char* kUnits[] = {"", "k", "M", "G"};
  size_t unit = 0;
  for (; std::abs(value) >= 9999.5 && unit < 3; ++unit) value /= 1000;
  return std::floor(value) == value ? fmt::format("{:.0f}{}", value, kUnits[unit])
                                    : fmt::format("{:.3g}{}", value, kUnits[unit]);
}

void draw_scale(Canvas& canvas, const HeatSummary& summary, int x, int y, int height, Rgb ink) {
  constexpr int kTicks = 4;
  const ColourMap colours;
  for (int row = 0; row < height; ++row)
    canvas.fill(x, y + row, kBar, 1, colours.of(1.0 - double(row) / (height - 1)));
  for (int tick = 0; tick <= kTicks; ++tick) {
    const int at = y + (height - 1) * (kTicks - tick) / kTicks;
    const std::string number = short_number(summary.top * tick / kTicks);
    canvas.fill(x + kBar, at, kTick, 1, ink);
    canvas.write(x + kBar + kTick + 4, std::clamp(at - 8, y - 4, y + height - 12),
                 tick == kTicks && summary.max > summary.top ? number + " and more" : number, ink);
  }
}

}  // namespace

std::string heat_picture(const CostMap& map) {
  const CostMap small = reduced(map);
  Canvas canvas(int(small.width), int(small.height), {0, 0, 0});
  draw_map(canvas, small, summary_of(map).top, 0, 0, 1, 1);
  return canvas.png();
}

std::string heat_png(const CostMap& map) {
  constexpr Rgb kPaper = {255, 255, 255}, kInk = {30, 33, 38}, kMuted = {96, 102, 110};
  const CostMap small = reduced(map);
  const HeatSummary summary = summary_of(map);
  const uint32_t longest = std::max(small.width, small.height);
  const int scale = int(std::max(1u, kWantedPixels / std::max(longest, 1u)));
  const int scale_y = small.height * 8 < small.width ? std::max(scale, int(64 / small.height))
                                                     : scale;  // a launch of few rows is a stripe
  const int width = int(small.width) * scale, height = int(small.height) * scale_y,
            bar = std::max(height, 160);
  const std::string title =
      fmt::format("{} ({}{})", map.name, map.unit, map.unit == "fraction" ? "" : "s a pixel");
  const std::string numbers =
      fmt::format("min {}   mean {}   p99 {}   max {}", short_number(summary.min), short_number(summary.mean),
                  short_number(summary.p99), short_number(summary.max));
  const std::string note = fmt::format("{} x {} pixels", map.width, map.height);
  const int wide = std::max({width + kMargin + kBar + kTick + Canvas::text_width("00.00k and more"),
                             Canvas::text_width(title), Canvas::text_width(numbers)});
  Canvas canvas(wide + 2 * kMargin, bar + 2 * kMargin + 3 * kLine + 16, kPaper);
  canvas.write(kMargin, kMargin, title, kInk);
  const int top = kMargin + kLine + 4;
  draw_map(canvas, small, summary.top, kMargin, top, scale, scale_y);
  draw_scale(canvas, summary, kMargin + width + kMargin, top, bar, kInk);
  canvas.write(kMargin, top + bar + 10, numbers, kInk);
  canvas.write(kMargin, top + bar + 10 + kLine, note, kMuted);
  return canvas.png();
}

}  // namespace glint::report
