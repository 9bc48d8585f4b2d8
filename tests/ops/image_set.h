// Makes images of a geometry in every format, and finds their texels in plain bytes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "exec/image_view.h"
#include "tests/ops/op_lab.h"
#include "tests/ops/texels.h"

namespace glint::test {

// Describes a geometry as its name does: "a2d" has two coordinates and a layer before them.
struct Geometry {
  int axes = 1;
  bool has_layers = false, is_cube = false, is_buffer = false;
  size_t operands() const { return size_t(is_cube ? 3 : axes) + has_layers; }
};
// Finds the geometry among the words of an op's name.
Geometry geometry_of(const std::vector<std::string_view>& parts);

// Names a texel: x, y, z, layer, level.
struct TexelAt {
  std::array<int64_t, 3> at{};
  int64_t layer = 0, level = 0;
};

// Holds an image whose texels lie in rows: x, then y, z, layer and level.
struct PlainImage {
  exec::ImageView view;
  Format format;
  uint32_t handle = 0;
  int64_t extent(int axis, int64_t level) const;
  // Returns where a texel of the image lies in its bytes.
  size_t offset(const TexelAt& texel) const;
  Colour read(const Bytes& bytes, const TexelAt& texel) const;
};

enum class Formats { All, Floats, Integers };
// Adds an image of each format to the lab. The sizes differ, and those of cubes are square. `levels` is the
// largest number of levels.
std::vector<PlainImage> add_images(OpLab& lab, const Geometry& geometry, Formats formats, uint32_t levels,
                                   Random& random);
// Fills the images with texels of moderate numbers, and integers with any.
void fill_moderate(const std::vector<PlainImage>& images, Spaces& spaces, Random& random);

}  // namespace glint::test
