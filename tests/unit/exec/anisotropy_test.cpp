// Tests the anisotropic filter: how many samples a footprint takes, at which level, and where they lie.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include "exec/texture_address.h"
#include "tests/support/catch.h"
#include "tests/unit/exec/image_lab.h"

namespace glint::exec {
namespace {

using isa::ImageShape;

constexpr float kSize = 64;

// Returns an image of 64 x 64 texels in one level, sampled at its nearest texels with up to 16 samples.
ImageView flat(ImageShape shape = ImageShape::D2) {
  ImageView out = view_of(shape, uint32_t(kSize), shape == ImageShape::D1 ? 1 : uint32_t(kSize),
                          shape == ImageShape::D3 ? uint32_t(kSize) : 1);
  out.sampler.max_anisotropy = 16;
  return out;
}

}  // namespace

TEST_CASE("a footprint has as many samples as its longer side has shorter ones, at the level of these") {
  struct Case {
    float x, y, most;  // the sides in texels: dx lies along s, and dy along t
    float lod;
    uint32_t samples;
    bool is_along_y;
  };
  const float infinity = std::numeric_limits<float>::infinity();
  for (const auto& [x, y, most, lod, samples, is_along_y] :
       {Case{8, 2, 16, 1, 4, false},
        {2, 9, 16, 1, 5, true},   // 4.5 samples are 5
        {32, 1, 4, 3, 4, false},  // The sampler allows 4, which are 8 texels wide each.
        {32, 1, 1, 5, 1, false},  // It allows none but the isotropic one.
        {8, 0, 16, 0, 8, false},  // A line takes no more samples than it has texels.
        {40, 0, 16, std::log2(2.5f), 16, false},
        {0.5f, 0.25f, 16, -1, 1, false},  // So does a footprint below a texel.
        {4, 4, 16, 2, 1, false},
        {0, 0, 16, -infinity, 1, false},
        {infinity, 1, 16, infinity, 1, false}}) {
    CAPTURE(x, y, most);
    const Footprint footprint = footprint_of(flat(), 2, {x / kSize, 0, 0}, {0, y / kSize, 0}, most);
    CHECK(footprint.lod == lod);
    CHECK(footprint.samples == samples);
    CHECK(footprint.is_along_y == is_along_y);
  }
}

TEST_CASE("the samples of a footprint lie evenly along its longer side, and their mean is the result") {
  ImageLab lab;
  const uint32_t handle = add_pattern(lab, flat());
  const auto sample = [&](float s, float t, float dx, float dy) {
    return number(lab.run_one("tex.grad.2d.v4.f32.f32",
                              {handle, bits(s), bits(t), bits(dx), bits(0.0f), bits(0.0f), bits(dy)})[0]);
  };
  for (const auto& [dx, dy, count] : {std::array{10.0f, 2.5f, 4.0f}, {3.0f, 21.0f, 7.0f}}) {
    double sum = 0;
    for (int i = 1; i <= int(count); ++i) {
      const double along = i / (double(count) + 1) - 0.5;
      const TexelIndex at{uint32_t(20.5 + (dx > dy ? along * dx : 0)),
                          uint32_t(30.5 + (dy > dx ? along * dy : 0))};
      sum += double(pattern(at));
    }
    CHECK(sample(20.5f / kSize, 30.5f / kSize, dx / kSize, dy / kSize) == Catch::Approx(sum / double(count)));
    CHECK(lab.texels.rows().size() == size_t(count));
  }
}

TEST_CASE("each sample of an anisotropic filter has the texels of the sampler's own filters") {
  ImageLab lab;
  ImageView image = flat();
  image.levels = 7;
  image.sampler.mag = image.sampler.min = image.sampler.mip = Filter::Linear;
  const uint32_t handle = add_pattern(lab, image);
  const auto texels = [&](float dx, float dy) {
    lab.run_one("tex.grad.2d.v4.f32.f32",
                {handle, bits(0.5f), bits(0.5f), bits(dx / kSize), bits(0.0f), bits(0.0f), bits(dy / kSize)});
    return lab.texels.rows().size();
  };
  CHECK(texels(3, 3) == 8);
  CHECK(texels(12, 3) == 4 * 8);
  CHECK(texels(8, 2) == 4 * 4);  // exactly level 1
  CHECK(texels(60, 3) == kMaxTexels);
}

TEST_CASE("a level without gradients, integers, and images of one and three axes are sampled isotropically") {
  ImageLab lab;
  const uint32_t plane = add_pattern(lab, flat());
  lab.run_one("tex.level.2d.v4.f32.f32", {plane, bits(0.5f), bits(0.5f), bits(2.0f)});
  CHECK(lab.texels.rows().size() == 1);
  const uint32_t line = add_pattern(lab, flat(ImageShape::D1));
  lab.run_one("tex.grad.1d.v4.f32.f32", {line, bits(0.5f), bits(0.25f), bits(0.0f)});
  CHECK(lab.texels.rows().size() == 1);
  ImageView cube = flat(ImageShape::D3);
  cube.depth = 2;
  const uint32_t deep = lab.add(cube);
  const uint32_t half = bits(0.5f), quarter = bits(0.25f);
  lab.run_one("tex.grad.3d.v4.f32.f32", {deep, half, half, half, quarter, 0, 0, 0, 0, 0});
  CHECK(lab.texels.rows().size() == 1);
  ImageView integers = flat();
  integers.format = TexelFormat::R32Uint;
  const uint32_t whole = lab.add(integers);
  lab.put(whole, {32, 32}, {7, 0, 0, 0});
  CHECK(lab.run_one("tex.grad.2d.v4.u32.f32", {whole, half, half, quarter, 0, 0, 0})[0] == 7);
}

TEST_CASE("samples of a cube that pass an edge lie on the neighbouring face") {
  ImageLab lab;
  ImageView image = view_of(ImageShape::Cube, 16, 16);
  image.layers = 6;
  image.sampler.max_anisotropy = 16;
  const uint32_t handle = lab.add(image);
  for (TexelIndex at; at.layer < 6; ++at.layer)
    for (at.y = 0; at.y < 16; ++at.y)
      for (at.x = 0; at.x < 16; ++at.x) lab.put(handle, at, floats(float(at.layer), 0, 0, 0));
  // The direction is the edge between +x, which is layer 0, and +z, which is layer 4. Four samples move along
  // z across it: two of them meet each face.
  const auto sample = [&](float z, float dz, float dy) {
    return number(lab.run_one("tex.grad.cube.v4.f32.f32",
                              {handle, bits(1.0f), bits(0.0f), bits(z), 0, 0, bits(dz), 0, bits(dy), 0})[0]);
  };
  CHECK(sample(0.999f, 0.5f, 0.125f) == 2.0f);
  CHECK(lab.texels.rows().size() == 4);
  CHECK(sample(0.5f, 0.5f, 0.125f) == 0.0f);
}

TEST_CASE("an anisotropic comparison is the share of samples that pass") {
  ImageLab lab;
  ImageView image = flat();
  image.sampler.compare = Comparison::Less;
  const uint32_t handle = lab.add(image);
  for (uint32_t y = 0; y < 64; ++y)
    for (uint32_t x = 0; x < 64; ++x) lab.put(handle, {x, y}, floats(x < 32 ? 1.0f : 0.0f, 0, 0, 0));
  const auto passed = [&](float s) {
    return number(lab.run_one(
        "tex.grad.compare.2d.f32.f32",
        {handle, bits(s / kSize), bits(0.5f), bits(8 / kSize), 0, 0, bits(2 / kSize), bits(0.5f)})[0]);
  };
  CHECK(passed(20) == 1.0f);
  CHECK(passed(32) == 0.5f);
  CHECK(passed(33) == 0.25f);
}

}  // namespace glint::exec
