// Tests what each kind of image access gives, with textures whose texels tell where they lie.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>

#include "tests/shaders/compute_lab.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

using exec::TexelFormat;
using isa::ImageShape;

constexpr uint32_t kLanesUsed = 32, kRow = 32;

exec::Sampler sampler(exec::Filter filter) {
  exec::Sampler s;
  s.mag = s.min = filter;
  return s;
}

// Returns an image whose texel n is `first` + n.
LabImage counting(ImageShape shape, std::array<uint32_t, 3> size, uint32_t layers, uint32_t levels,
                  float first) {
  LabImage image;
  exec::ImageView& view = image.view;
  view.format = TexelFormat::R32Float;
  view.shape = shape;
  view.width = size[0], view.height = size[1], view.depth = size[2], view.layers = layers,
  view.levels = levels;
  view.sampler = sampler(exec::Filter::Nearest);
  for (uint64_t i = 0; i < view.bytes() / 4; ++i)
    image.texels.push_back(std::bit_cast<uint32_t>(first + float(i)));
  return image;
}

ComputeLab lab_of_images() {
  ComputeLab lab("compute/images.comp");
  lab.buffers[0] = Words(kLanesUsed * kRow);
  lab.images[1] = {counting(ImageShape::D2, {4, 4, 1}, 1, 3, 1)};  // levels begin with 1, 17, 21
  lab.images[2] = {counting(ImageShape::A2d, {2, 2, 1}, 3, 1, 100)};
  lab.images[3] = {counting(ImageShape::D3, {2, 2, 2}, 1, 1, 200)};
  lab.images[4] = {counting(ImageShape::Cube, {1, 1, 1}, 6, 1, 300)};
  LabImage seven = counting(ImageShape::D2, {1, 1, 1}, 1, 1, 0), nine = seven;
  seven.view.format = nine.view.format = TexelFormat::R32Uint;
  seven.texels = {7}, nine.texels = {9};
  lab.images[5] = {seven, nine};
  lab.images[6] = {counting(ImageShape::D2, {2, 2, 1}, 1, 1, 10)};
  lab.samplers[7] = {sampler(exec::Filter::Nearest), sampler(exec::Filter::Linear)};
  lab.images[8] = {counting(ImageShape::Buffer, {32, 1, 1}, 1, 1, 500)};
  lab.images[9] = {counting(ImageShape::D3, {2, 2, 2}, 1, 1, 20)};
  LabImage layers = counting(ImageShape::A2d, {2, 1, 1}, 3, 1, 0);
  layers.view.format = TexelFormat::Rgba32Float;
  layers.texels = Words(24);
  lab.images[10] = {layers};
  LabImage line = counting(ImageShape::Buffer, {32, 1, 1}, 1, 1, 0);
  line.view.format = TexelFormat::R32Sint;
  lab.images[11] = {line};
  lab.images[12] = {counting(ImageShape::D1, {4, 1, 1}, 1, 1, 40)};
  LabImage shadow = counting(ImageShape::D2, {2, 2, 1}, 1, 1, 0);
  shadow.texels = Words(4, std::bit_cast<uint32_t>(0.5f));
  shadow.view.sampler.compare = exec::Comparison::Less;
  lab.images[13] = {shadow};
  lab.images[14] = {counting(ImageShape::Cube, {1, 1, 1}, 6, 1, 0)};
  return lab;
}

// Returns what the lane's row must hold; the shader is images.comp.
std::vector<float> expected_row(uint32_t id) {
  const uint32_t x = id & 3, y = id >> 2 & 3;
  const auto flat = [](uint32_t tx, uint32_t ty) { return 1.0f + float(4 * ty + tx); };
  const float level_1 = 17.0f + float(2 * (y / 2) + x / 2);
  const uint32_t gx = x & 1, gy = y & 1;  // between texels gx and gx + 1
  const float gathered =
      flat(gx, gy + 1) + 100.0f * flat(gx + 1, gy + 1) + 10000.0f * flat(gx + 1, gy) + 0.01f * flat(gx, gy);
  const uint32_t axis = id % 3, face = 2 * axis + (id & 8 ? 1 : 0);
  return {flat(x, y),
          level_1,
          21.0f,
          flat(std::min(x + 1, 3u), y == 0 ? 0 : y - 1),
          level_1 + flat((x & 1) + 2, (y & 1) + 1),
          gathered,
          float(100 + 4 * axis + 2),
          float(200 + (id & 7)),
          float(300 + face),
          id & 1 ? 9.0f : 7.0f,
          id & 1 ? 11.5f : 13.0f,
          11.0f,
          float(500 + id),
          43.0f,
          float(id) / 32.0f < 0.5f ? 1.0f : 0.0f,
          float(2 + 20 + 300),
          float(3 + 20 + 3200 + 10000),
          float(3 + 20 + 3200 + 10000),
          2.0f};
}

TEST_CASE(
    "images of every geometry are sampled, fetched, gathered, measured, read and written where they should "
    "be") {
  for (const LabOptions& options : compute_lab_options()) {
    INFO(to_string(options));
    ComputeLab lab = lab_of_images();
    lab.run(options);
    for (uint32_t id = 0; id < kLanesUsed; ++id) {
      const std::vector<float> expected = expected_row(id);
      for (size_t i = 0; i < expected.size(); ++i) {
        INFO("lane " << id << " word " << i);
        if (i == 5)
          CHECK(std::bit_cast<float>(lab.buffers[0][id * kRow + i]) == Approx(expected[i]));
        else
          CHECK(std::bit_cast<float>(lab.buffers[0][id * kRow + i]) == expected[i]);
      }
      CHECK(lab.images[11][0].texels[id] == uint32_t(-int32_t(id)));
      if (id < 8) CHECK(std::bit_cast<float>(lab.images[9][0].texels[id]) == float(20 + 2 * id));
      if (id < 6) CHECK(std::bit_cast<float>(lab.images[14][0].texels[id]) == float(10 + id));
      if (id < 3) CHECK(std::bit_cast<float>(lab.images[10][0].texels[8 * id + 4]) == float(id));
    }
  }
}

}  // namespace
}  // namespace glint::test
