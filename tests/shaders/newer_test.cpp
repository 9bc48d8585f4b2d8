// Tests GLSL that is newer than glslang 12, and images of several samples.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <limits>

#include "tests/shaders/compute_lab.h"
#include "tests/shaders/lane_checks.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

// Describes the laboratory's quads: which triangle of which quad lane (x, y) looks at, and its corners in
// object space.
struct Triangle {
  float corner[3][3];
};
Triangle triangle_of(uint32_t x, uint32_t y) {
  const auto left = float(x % 2), right = left + 1;
  if (y < 3) return {{{left, 0, 0}, {right, 0, 0}, {right, 6, 0}}};
  return {{{left, 0, 0}, {right, 6, 0}, {left, 6, 0}}};
}

TEST_CASE("hit shaders and ray queries read the corners of the triangle, candidate or hit, in object space") {
  const LabShaders::Group group{"newer/corners.rchit", "newer/corners.rahit", ""};
  RayLab lab({"newer/corners.rgen", {"newer/none.rmiss"}, {group, group, {}, {}, group, group}, {}});
  lab.words_per_lane = 32;
  check_pixels(lab, [](uint32_t x, uint32_t y) {
    Row row(21, 0);
    if (x < 2 || x >= 6) return row;
    const Triangle t = triangle_of(x, y);
    for (size_t i = 0; i < 9; ++i) row[i] = row[11 + i] = bits(t.corner[i / 3][i % 3]);
    if (x % 2 == 0) return row;  // opaque: no any-hit shader runs
    const uint32_t corner = (x + y) % 3;
    row[9] = bits(t.corner[corner][0]), row[10] = bits(t.corner[2][corner]);
    row[20] = bits(t.corner[1][0] + t.corner[2][1]);
    return row;
  });
}

TEST_CASE("hit objects go by the names of EXT as by those of NV") {
  const LabShaders::Group group{"newer/corners.rchit", "", ""};
  RayLab lab({"newer/reorder.rgen", {"newer/none.rmiss"}, {group, group, {}, {}, group, group}, {}});
  lab.words_per_lane = 32;
  check_pixels(lab, [](uint32_t x, uint32_t y) {
    if (x < 2 || x >= 6) return Row{2, 0, 0};
    return Row{1, y < 3 ? 0u : 1u, bits(triangle_of(x, y).corner[1][0])};
  });
}

TEST_CASE("extensions younger than the compiler mean what they say: hints, rotations, dot products") {
  for (const LabOptions& options : compute_lab_options()) {
    ComputeLab lab("newer/extensions.comp");
    lab.buffers[0] = Words(256);
    lab.run(options);
    const Words& got = lab.buffers[0];
    // The bytes of a are 1, 127, -1, -128 (unsigned 1, 127, 255, 128), and those of b are 3, -1, 2, 127
    // (unsigned 3, 255, 2, 127).
    const int32_t both = 3 - 127 - 2 - 128 * 127, mixed = 3 + 127 * 255 - 2 - 128 * 127;
    const uint32_t none = 3 + 127 * 255 + 255 * 2 + 128 * 127;
    for (uint32_t lane = 0; lane < 32; ++lane) {
      INFO(to_string(options) << " lane " << lane);
      const uint32_t from = (lane + 5) % 32;
      CHECK(got[lane] == (from > 3 ? from * 10 : 7));
      CHECK(got[32 + lane] == (lane & ~7u) + (lane + 3) % 8);
      CHECK(int32_t(got[64 + lane]) == both);
      CHECK(got[96 + lane] == none);
      CHECK(int32_t(got[128 + lane]) == mixed);
      CHECK(int32_t(got[160 + lane]) == std::numeric_limits<int32_t>::min());
      CHECK(got[192 + lane] == 0xffff'ffff);
      CHECK(int32_t(got[224 + lane]) == int32_t(lane) - 10 + 21);
    }
  }
}

TEST_CASE("dot products wrap at 32 bits, or saturate together with the number that they are added to") {
  for (const LabOptions& options : compute_lab_options()) {
    ComputeLab lab("newer/dots.comp");
    lab.buffers[0] = Words(224);
    lab.run(options);
    const auto clamped = [](int64_t x) {
      return uint32_t(
          std::clamp<int64_t>(x, std::numeric_limits<int32_t>::min(), std::numeric_limits<int32_t>::max()));
    };
    for (uint32_t lane = 0; lane < 32; ++lane) {
      INFO(to_string(options) << " lane " << lane);
      const auto got = [&](uint32_t i) { return lab.buffers[0][32 * i + lane]; };
      const int64_t l = lane;
      CHECK(int32_t(got(0)) == -2 * l - 9);  // the first product is 2^32
      CHECK(got(1) == 128 * l + 255 * 255 + 2 + 255 * 255);
      CHECK(int32_t(got(2)) == -128 * 255 - 255 + 2 + 3 * l);
      CHECK(got(3) == 85 + 2 * l);
      CHECK(got(4) == clamped(-32768 * 32767 + l - 1073774600));  // the first eight lanes are below the range
      CHECK(got(5) == (lane < 13 ? 0xfffffff3 + lane : ~0u));
      CHECK(got(6) == clamped(127 * 255 + l + 2147451250));  // lanes from 13 on are above the range
    }
  }
}

LabImage samples(isa::ImageShape shape, uint32_t layers, uint32_t number) {
  LabImage image;
  exec::ImageView& view = image.view;
  view.format = exec::TexelFormat::R32Uint, view.shape = shape;
  view.width = view.height = 2, view.layers = layers * number, view.samples = number;
  for (uint32_t i = 0; i < view.bytes() / 4; ++i) image.texels.push_back(i);
  return image;
}

TEST_CASE("each sample of a texel is its own, and stores to samples that an image lacks are dropped") {
  for (const LabOptions& options : compute_lab_options()) {
    ComputeLab lab("compute/samples.comp");
    lab.buffers[0] = Words(64);
    lab.images[1] = {samples(isa::ImageShape::D2, 1, 4)};
    lab.images[2] = {samples(isa::ImageShape::A2d, 3, 2)};
    lab.images[3] = {samples(isa::ImageShape::D2, 1, 2)};
    lab.run(options);
    for (uint32_t lane = 0; lane < 4; ++lane) {
      INFO(to_string(options) << " lane " << lane);
      const Words expected{lane * 100,
                           lane * 100 + 1,
                           lane * 100 + 2,
                           lane * 100 + 3,
                           lane * 100 + 7,
                           4,
                           22,
                           203,
                           lane + 40,
                           (4 + lane) * 1000 + lane,
                           22};
      for (uint32_t i = 0; i < expected.size(); ++i) {
        INFO("word " << i);
        CHECK(lab.buffers[0][lane * 16 + i] == expected[i]);
      }
    }
  }
}

TEST_CASE("texels of 64 bits are loaded, stored, fetched and changed by every atomic") {
  for (const LabOptions& options : compute_lab_options()) {
    ComputeLab lab("compute/wide_texels.comp");
    lab.buffers[0] = Words(64);
    LabImage image;
    image.view.format = exec::TexelFormat::Rg32Uint;
    image.view.width = 32, image.view.height = 1;
    image.texels = Words(64);
    lab.images[1] = {image};
    lab.run(options);
    for (uint32_t lane = 0; lane < 32; ++lane) {
      INFO(to_string(options) << " lane " << lane);
      // Every lane adds 2^32 + 1 to texel 0, which began as 2^32 - 1. The sum carries into the high half.
      CHECK(lab.buffers[0][2 * lane] == (lane == 0 ? 31u : lane + 5));
      CHECK(lab.buffers[0][2 * lane + 1] == (lane == 0 ? 33u : 0x8000'0000u + lane));
    }
    CHECK(lab.images[1][0].texels[2] == 6);  // of texel 1
  }
}

}  // namespace
}  // namespace glint::test
