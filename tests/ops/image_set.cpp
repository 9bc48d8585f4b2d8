// Makes images of a geometry in every format, and finds their texels in plain bytes.
// SPDX-License-Identifier: Apache-2.0
#include "tests/ops/image_set.h"

#include <algorithm>
#include <cstddef>
#include <stdexcept>

namespace glint::test {

using isa::ImageShape;

Geometry geometry_of(const std::vector<std::string_view>& parts) {
  for (std::string_view part : parts) {
    if (part == "buffer") return {1, false, false, true};
    if (part == "1d" || part == "2d" || part == "3d") return {part[0] - '0', false};
    if (part == "a1d" || part == "a2d") return {part[1] - '0', true};
    if (part == "cube" || part == "acube") return {2, part[0] == 'a', true};
  }
  throw std::logic_error("an image op names no geometry");
}

int64_t PlainImage::extent(int axis, int64_t level) const {
  const int64_t full = axis == 0 ? view.width : axis == 1 ? view.height : view.depth;
  return std::max<int64_t>(full >> level, 1);
}

size_t PlainImage::offset(const TexelAt& texel) const {
  int64_t before = 0;
  for (int64_t level = 0; level < texel.level; ++level)
    before += extent(0, level) * extent(1, level) * extent(2, level) * view.layers;
  const int64_t row =
      (texel.layer * extent(2, texel.level) + texel.at[2]) * extent(1, texel.level) + texel.at[1];
  return size_t(before + row * extent(0, texel.level) + texel.at[0]) * format.bytes();
}

Colour PlainImage::read(const Bytes& bytes, const TexelAt& texel) const {
  return read_texel(format, bytes.data() + offset(texel));
}

namespace {

ImageShape shape_of(const Geometry& geometry, bool with_layers) {
  if (geometry.is_buffer) return ImageShape::Buffer;
  if (geometry.is_cube) return geometry.has_layers ? ImageShape::Acube : ImageShape::Cube;
  if (geometry.axes == 3) return ImageShape::D3;
  if (geometry.axes == 2) return with_layers ? ImageShape::A2d : ImageShape::D2;
  return with_layers ? ImageShape::A1d : ImageShape::D1;
}

exec::ImageView view_of(const Geometry& geometry, size_t number, uint32_t levels) {
  // Powers of two make coordinates exact, and other sizes show what is not. A row holds two of the widest
  // accesses of bytes.
  constexpr uint32_t kWidths[] = {32, 35, 64, 33}, kHeights[] = {8, 5, 16, 6, 4}, kDepths[] = {4, 3, 2};
  exec::ImageView view;
  view.shape = shape_of(geometry, geometry.has_layers);
  view.width = geometry.is_cube ? kHeights[number % 5] : kWidths[number % 4];
  if (geometry.axes > 1) view.height = kHeights[number % 5];
  if (geometry.axes > 2) view.depth = kDepths[number % 3];
  if (geometry.has_layers) view.layers = 3;
  if (geometry.is_cube) view.layers *= 6;
  view.levels = uint32_t(1 + number % levels);
  return view;
}

}  // namespace

std::vector<PlainImage> add_images(OpLab& lab, const Geometry& geometry, Formats formats, uint32_t levels,
                                   Random& random) {
  std::vector<PlainImage> out;
  const size_t shift = random.below(64);
  for (size_t i = 0; i < size_t(exec::kFirstBlockFormat); ++i) {
    PlainImage image;
    image.format = format_of(exec::info_of(exec::TexelFormat(i)).name);
    if (formats != Formats::All && image.format.is_integer() != (formats == Formats::Integers)) continue;
    image.view = view_of(geometry, out.size() + shift, levels);
    image.view.format = exec::TexelFormat(i);
    image.handle = lab.add_image(image.view);
    out.push_back(image);
  }
  return out;
}

void fill_moderate(const std::vector<PlainImage>& images, Spaces& spaces, Random& random) {
  for (const PlainImage& image : images) {
    Bytes& bytes = spaces.images[image.handle];
    for (size_t at = 0; at < bytes.size(); at += image.format.bytes()) {
      Words words{};
      for (uint32_t& word : words) {
        const double number = double(random.below(4097)) / 1024 - 2;
        word = image.format.is_integer() ? uint32_t(random.next() >> random.below(32))
                                         : words_of(image.format, {number})[0];
      }
      const auto texel = texel_of(image.format, words);
      std::copy(texel.begin(), texel.end(), bytes.begin() + std::ptrdiff_t(at));
    }
  }
}

}  // namespace glint::test
