// Tests sampling (addressing, filtering, levels, cubes, gathers, queries) against values by hand and in
// doubles.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include "exec/texture_address.h"
#include "tests/support/catch.h"
#include "tests/unit/exec/image_lab.h"

namespace glint::exec {
namespace {

using F = TexelFormat;
using isa::ImageShape;

// Adds four texels 0, 1, 2, 3 in a row, with border 9.
uint32_t add_ramp(ImageLab& lab, Wrap mode, Filter filter) {
  ImageView image = view_of(ImageShape::D1, 4);
  image.sampler.wrap.fill(mode);
  image.sampler.mag = image.sampler.min = filter;
  image.sampler.border = floats(9, 9, 9, 9);
  const uint32_t handle = lab.add(image);
  for (uint32_t x = 0; x < 4; ++x) lab.put(handle, {x}, floats(float(x), 0, 0, 0));
  return handle;
}

// Computes the textbook's linear filter of repeated patterns in doubles.
double linear(const ImageView& image, uint32_t level, const double* at, int axes) {
  double sum = 0;
  for (int corner = 0; corner < 1 << axes; ++corner) {
    double weight = 1;
    uint32_t index[3] = {0, 0, 0};
    for (int axis = 0; axis < axes; ++axis) {
      const double size = image.extent(axis, level), x = at[axis] * size - 0.5, low = std::floor(x);
      const bool upper = corner >> axis & 1;
      weight *= upper ? x - low : 1 - (x - low);
      index[axis] = uint32_t(std::fmod(low + upper + 8 * size, size));
    }
    sum += weight * double(pattern({index[0], index[1], index[2], 0, level}));
  }
  return sum;
}

}  // namespace

TEST_CASE("each wrap mode finds its texel on both sides of the edges") {
  const std::pair<Wrap, std::vector<float>> expected[] = {
      // Each list holds texels -5 to 8.
      {Wrap::Repeat, {3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0}},
      {Wrap::MirroredRepeat, {3, 3, 2, 1, 0, 0, 1, 2, 3, 3, 2, 1, 0, 0}},
      {Wrap::ClampToEdge, {0, 0, 0, 0, 0, 0, 1, 2, 3, 3, 3, 3, 3, 3}},
      {Wrap::ClampToBorder, {9, 9, 9, 9, 9, 0, 1, 2, 3, 9, 9, 9, 9, 9}},
      {Wrap::MirrorClampToEdge, {3, 3, 2, 1, 0, 0, 1, 2, 3, 3, 3, 3, 3, 3}}};
  for (const auto& [mode, values] : expected)
    for (int i = -5; i <= 8; ++i) {
      ImageLab lab;
      const uint32_t handle = add_ramp(lab, mode, Filter::Nearest);
      const auto texel = lab.run_one("tex.1d.v4.f32.f32", {handle, bits((float(i) + 0.5f) / 4)});
      INFO("mode " << int(mode) << " texel " << i);
      CHECK(number(texel[0]) == values[size_t(i + 5)]);
      CHECK(number(texel[1]) == 0.0f);  // the format has one channel, and so has the border
      CHECK(number(texel[3]) == 1.0f);
    }
}

TEST_CASE("a linear filter mixes the edge with what its wrap mode puts beyond it") {
  for (const auto& [mode, left] : {std::pair{Wrap::Repeat, 3.0f},
                                   {Wrap::MirroredRepeat, 0.0f},
                                   {Wrap::ClampToEdge, 0.0f},
                                   {Wrap::ClampToBorder, 9.0f},
                                   {Wrap::MirrorClampToEdge, 0.0f}}) {
    ImageLab lab;
    const uint32_t handle = add_ramp(lab, mode, Filter::Linear);
    CHECK(number(lab.run_one("tex.1d.v4.f32.f32", {handle, bits(0.0f)})[0]) == left / 2);
    CHECK(number(lab.run_one("tex.1d.v4.f32.f32", {handle, bits(0.5f)})[0]) == 1.5f);
  }
}

TEST_CASE("a filter takes the least or the greatest of the texels that have weights") {
  ImageLab lab;
  const uint32_t handle = add_ramp(lab, Wrap::ClampToBorder, Filter::Linear);
  const auto at = [&](Reduction reduction, float texel) {
    lab.image(handle).sampler.reduction = reduction;
    return number(lab.run_one("tex.1d.v4.f32.f32", {handle, bits(texel / 4)})[0]);
  };
  CHECK(at(Reduction::Least, 1.75f) == 1);
  CHECK(at(Reduction::Greatest, 1.75f) == 2);
  // In the middle of a texel its neighbours have no weight.
  CHECK(at(Reduction::Least, 1.5f) == 1);
  CHECK(at(Reduction::Greatest, 1.5f) == 1);
  CHECK(at(Reduction::Greatest, 3.75f) == 9);
  CHECK(at(Reduction::Least, 3.75f) == 3);
}

TEST_CASE("coordinates that are not numbers, infinite or huge read some texel and fault nowhere") {
  for (Wrap mode :
       {Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge, Wrap::ClampToBorder, Wrap::MirrorClampToEdge})
    for (float x : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -3e38f,
                    1e20f, -1e10f}) {
      ImageLab lab;
      const float texel =
          number(lab.run_one("tex.1d.v4.f32.f32", {add_ramp(lab, mode, Filter::Linear), bits(x)})[0]);
      CHECK(!lab.fault);
      CHECK((texel >= 0 && texel <= 9));
    }
}

TEST_CASE("bilinear and trilinear filters equal plain doubles") {
  for (int axes = 1; axes <= 3; ++axes) {
    ImageLab lab;
    ImageView image = view_of(axes == 1   ? ImageShape::D1
                              : axes == 2 ? ImageShape::D2
                                          : ImageShape::D3,
                              16, axes > 1 ? 8 : 1, axes > 2 ? 4 : 1);
    image.levels = 4;
    image.sampler.mag = image.sampler.min = image.sampler.mip = Filter::Linear;
    image.sampler.wrap.fill(Wrap::Repeat);
    const uint32_t handle = add_pattern(lab, image);
    std::vector<ImageLab::Column> sources{lab.all(handle)};
    for (int axis = 0; axis < axes; ++axis) {
      sources.push_back({});
      for (int lane = 0; lane < kLanes; ++lane)
        sources.back()[size_t(lane)] = bits(float((lane * 29 + axis * 7) % 64) / 23.0f - 1.0f);
    }
    sources.push_back({});
    for (int lane = 0; lane < kLanes; ++lane)
      sources.back()[size_t(lane)] = bits(float(lane) / 10.0f);  // levels 0 to 3.1
    const std::string name = std::string("tex.level.") + "123"[axes - 1] + "d.v4.f32.f32";
    const auto out = lab.run(name, sources);
    for (size_t lane = 0; lane < kLanes; ++lane) {
      double at[3] = {};
      for (int axis = 0; axis < axes; ++axis) at[axis] = double(number(sources[size_t(axis) + 1][lane]));
      const double lod = std::min(double(number(sources.back()[lane])), 3.0), low = std::floor(lod);
      const double expected = linear(image, uint32_t(low), at, axes) * (1 - (lod - low)) +
                              linear(image, uint32_t(std::min(low + 1, 3.0)), at, axes) * (lod - low);
      INFO(name << " lane " << lane);
      CHECK(double(number(out[0][lane])) == Catch::Approx(expected).margin(2e-5));
    }
    CHECK(lab.texels.rows().size() == size_t{2} << axes);
  }
}

TEST_CASE("the level of detail comes from the level, its bias and its limits, or from the gradients") {
  ImageLab lab;
  ImageView image = view_of(ImageShape::D2, 8, 4);
  image.levels = 4;
  const uint32_t handle = lab.add(image);
  for (TexelIndex at; at.level < 4; ++at.level)
    for (at.y = 0; at.y < image.extent(1, at.level); ++at.y)
      for (at.x = 0; at.x < image.extent(0, at.level); ++at.x)
        lab.put(handle, at, floats(float(at.level), 0, 0, 0));
  const auto level = [&](float lod) {
    return number(lab.run_one("tex.level.2d.v4.f32.f32", {handle, bits(0.3f), bits(0.3f), bits(lod)})[0]);
  };
  const auto grad = [&](float ux, float vx, float uy, float vy) {
    return number(lab.run_one("tex.grad.2d.v4.f32.f32",
                              {handle, bits(0.3f), bits(0.3f), bits(ux), bits(vx), bits(uy), bits(vy)})[0]);
  };
  Sampler& sampler = lab.image(handle).sampler;
  CHECK(level(-1) == 0);
  CHECK(level(0.5f) == 0);  // the finer level
  CHECK(level(0.6f) == 1);
  CHECK(level(10) == 3);
  CHECK(level(std::numeric_limits<float>::quiet_NaN()) == 0);
  sampler.mip = Filter::Linear;
  CHECK(level(1.25f) == 1.25f);
  sampler.lod_bias = 0.5f;
  CHECK(level(1.25f) == 1.75f);
  sampler.max_lod = 1.5f;
  CHECK(level(1.25f) == 1.5f);
  sampler.min_lod = 1.0f;
  CHECK(level(-5) == 1);
  sampler = image.sampler;
  sampler.mip = Filter::Linear;
  CHECK(grad(2 / 8.0f, 0, 0, 0) == Catch::Approx(1));
  CHECK(grad(0, 0, 0, 4 / 4.0f) == Catch::Approx(2));
  CHECK(grad(3 / 8.0f, 4 / 4.0f, 1 / 8.0f, 0) == Catch::Approx(std::log2(5)));
  CHECK(grad(0, 0, 0, 0) == 0);
  CHECK(grad(100, 0, 0, 0) == 3);
}

TEST_CASE("magnified and minified texels take their own filter") {
  ImageLab lab;
  const uint32_t handle = add_ramp(lab, Wrap::ClampToEdge, Filter::Nearest);
  lab.image(handle).sampler.mag = Filter::Linear;
  CHECK(number(lab.run_one("tex.level.1d.v4.f32.f32", {handle, bits(0.5f), bits(0.0f)})[0]) == 1.5f);
  CHECK(number(lab.run_one("tex.level.1d.v4.f32.f32", {handle, bits(0.5f), bits(0.1f)})[0]) == 2.0f);
}

TEST_CASE("unnormalised coordinates count texels, and offsets move by texels") {
  ImageLab lab;
  const uint32_t handle = add_ramp(lab, Wrap::Repeat, Filter::Nearest);
  CHECK(number(lab.run_one("tex.offset.1d.v4.f32.f32", {handle, bits(0.125f), 2})[0]) == 2.0f);
  // The offset is -1.
  CHECK(number(lab.run_one("tex.offset.1d.v4.f32.f32", {handle, bits(0.125f), 0xff})[0]) == 3.0f);
  lab.image(handle).sampler.unnormalized = true;
  CHECK(number(lab.run_one("tex.1d.v4.f32.f32", {handle, bits(2.5f)})[0]) == 2.0f);
  CHECK(lab.run_one("txq.normalized_coords.b32", {handle})[0] == 0);
}

TEST_CASE("layers are clamped to those there are") {
  ImageLab lab;
  ImageView image = view_of(ImageShape::A2d, 2, 2);
  image.layers = 3;
  const uint32_t handle = add_pattern(lab, image);
  for (const auto& [asked, given] : {std::pair{-1, 0u}, {0, 0u}, {2, 2u}, {7, 2u}})
    CHECK(number(lab.run_one("tex.a2d.v4.f32.f32", {handle, uint32_t(asked), bits(0.9f), bits(0.1f)})[0]) ==
          pattern({1, 0, 0, given, 0}));
}

TEST_CASE("a gather gives one component of four texels, counter-clockwise from the lower left") {
  ImageLab lab;
  const uint32_t handle = lab.add(view_of(ImageShape::D2, 2, 2, 1, F::Rgba32Float));
  for (uint32_t y = 0; y < 2; ++y)
    for (uint32_t x = 0; x < 2; ++x)
      lab.put(handle, {x, y}, floats(float(10 * y + x), float(100 + 10 * y + x), 0, 7));
  const std::vector<uint32_t> middle{handle, bits(0.5f), bits(0.5f)};
  CHECK(lab.run_one("tld4.r.2d.v4.f32.f32", middle) == std::vector{bits(10), bits(11), bits(1), bits(0)});
  CHECK(lab.run_one("tld4.g.2d.v4.f32.f32", middle) ==
        std::vector{bits(110), bits(111), bits(101), bits(100)});
  CHECK(lab.run_one("tld4.a.2d.v4.f32.f32", middle) == std::vector{bits(7), bits(7), bits(7), bits(7)});
  CHECK(lab.run_one("tld4.offset.r.2d.v4.f32.f32", {handle, bits(0.5f), bits(0.5f), 1}) ==
        std::vector{bits(11), bits(11), bits(1), bits(1)});
  lab.image(handle).sampler.compare = Comparison::Less;
  CHECK(lab.run_one("tld4.compare.r.2d.v4.f32.f32", {handle, bits(0.5f), bits(0.5f), bits(5.0f)}) ==
        std::vector{bits(1), bits(1), bits(0), bits(0)});
}

TEST_CASE("comparisons happen before the filter") {
  const std::pair<Comparison, std::array<float, 3>> expected[] = {
      // The references lie below, at and above the texel.
      {Comparison::Never, {0, 0, 0}},          {Comparison::Less, {1, 0, 0}},
      {Comparison::Equal, {0, 1, 0}},          {Comparison::LessOrEqual, {1, 1, 0}},
      {Comparison::Greater, {0, 0, 1}},        {Comparison::NotEqual, {1, 0, 1}},
      {Comparison::GreaterOrEqual, {0, 1, 1}}, {Comparison::Always, {1, 1, 1}}};
  ImageLab lab;
  const uint32_t handle = add_ramp(lab, Wrap::ClampToEdge, Filter::Nearest);
  for (const auto& [comparison, results] : expected) {
    lab.image(handle).sampler.compare = comparison;
    for (size_t i = 0; i < 3; ++i)
      CHECK(number(lab.run_one("tex.compare.1d.f32.f32", {handle, bits(0.6f), bits(1.0f + float(i))})[0]) ==
            results[i]);
  }
  lab.image(handle).sampler.compare = Comparison::Less;
  lab.image(handle).sampler.mag = Filter::Linear;
  CHECK(number(lab.run_one("tex.compare.1d.f32.f32", {handle, bits(0.5f), bits(1.5f)})[0]) == 0.5f);
}

TEST_CASE(
    "texel fetches read the level and layer they name; outside they fault, or give 0 when images are "
    "robust") {
  ImageLab lab;
  ImageView image = view_of(ImageShape::A2d, 4, 2, 1, F::Rgba8Uint);
  image.layers = 2;
  image.levels = 2;
  const uint32_t handle = lab.add(image);
  lab.put(handle, {1, 0, 0, 1, 1}, {1, 2, 3, 4});
  CHECK(lab.run_one("tex.level.a2d.v4.u32.s32", {handle, 1, 1, 0, 1}) == std::vector<uint32_t>{1, 2, 3, 4});
  CHECK(lab.run_one("tex.a2d.v4.u32.s32", {handle, 1, 1, 0}) == std::vector<uint32_t>{0, 0, 0, 0});
  for (const std::vector<uint32_t>& at : {std::vector<uint32_t>{handle, 0, 4, 0, 0},
                                          {handle, 0, ~0u, 0, 0},
                                          {handle, 2, 0, 0, 0},
                                          {handle, 0, 2, 0, 1},
                                          {handle, 0, 0, 0, 2}}) {
    lab.world.robust_images = false;
    lab.run_one("tex.level.a2d.v4.u32.s32", at);
    REQUIRE(lab.fault);
    lab.world.robust_images = true;
    CHECK(lab.run_one("tex.level.a2d.v4.u32.s32", at) == std::vector<uint32_t>{0, 0, 0, 0});
    CHECK(!lab.fault);
    CHECK(lab.texels.empty());
  }
}

TEST_CASE("queries tell the size of an image and of its levels") {
  ImageLab lab;
  ImageView image = view_of(ImageShape::D3, 9, 6, 3);
  image.levels = 4;
  const uint32_t volume = lab.add(image);
  ImageView cubes = view_of(ImageShape::Acube, 4, 4, 1, F::Bgra8Srgb);
  cubes.layers = 12;
  const uint32_t cube = lab.add(cubes);
  const auto query = [&](std::string_view op, std::vector<uint32_t> sources) {
    return lab.run_one(op, sources)[0];
  };
  CHECK(query("txq.width.b32", {volume}) == 9);
  CHECK(query("txq.height.b32", {volume}) == 6);
  CHECK(query("txq.depth.b32", {volume}) == 3);
  CHECK(query("txq.level.width.b32", {volume, 1}) == 4);
  CHECK(query("txq.level.height.b32", {volume, 2}) == 1);
  CHECK(query("txq.level.depth.b32", {volume, 3}) == 1);
  CHECK(query("txq.num_mipmap_levels.b32", {volume}) == 4);
  CHECK(query("txq.array_size.b32", {cube}) == 2);
  CHECK(query("txq.num_samples.b32", {cube}) == 1);
  CHECK(query("txq.normalized_coords.b32", {cube}) == 1);
  CHECK(query("suq.width.b32", {cube}) == 4);
  CHECK(query("suq.channel_data_type.b32", {volume}) == 0x10de);  // CL_FLOAT
  CHECK(query("suq.channel_order.b32", {volume}) == 0x10b0);      // CL_R
  CHECK(lab.texels.empty());
}

TEST_CASE("a handle may name a sampler of its own") {
  ImageLab lab;
  const uint32_t handle = add_ramp(lab, Wrap::ClampToEdge, Filter::Nearest);
  Sampler linear_filter;
  lab.world.samplers.push_back(linear_filter);
  CHECK(number(lab.run_one("tex.1d.v4.f32.f32", {handle, bits(0.5f)})[0]) == 2.0f);
  CHECK(number(lab.run_one("tex.1d.v4.f32.f32", {handle | 1u << isa::kHandleSamplerShift, bits(0.5f)})[0]) ==
        1.5f);
  lab.run_one("tex.1d.v4.f32.f32", {handle | 2u << isa::kHandleSamplerShift, bits(0.5f)});
  CHECK(lab.fault);
}

TEST_CASE("each lane has its own image, and idle lanes keep their registers") {
  ImageLab lab;
  const uint32_t a = add_ramp(lab, Wrap::ClampToEdge, Filter::Nearest),
                 b = add_pattern(lab, view_of(ImageShape::D1, 4));
  ImageLab::Column handle;
  for (size_t lane = 0; lane < kLanes; ++lane) handle[lane] = lane % 2 ? b : a;
  const auto out = lab.run("tex.1d.v4.f32.f32", {handle, lab.all(0.4f)}, 0x0000'ffff);
  for (size_t lane = 0; lane < kLanes; ++lane)
    CHECK(out[0][lane] == (lane >= 16 ? ImageLab::kUntouched : lane % 2 ? bits(pattern({1})) : bits(1.0f)));
}

TEST_CASE("what no sampler can do is a fault that names the image") {
  ImageLab lab;
  const uint32_t integers = lab.add(view_of(ImageShape::D2, 4, 4, 1, F::R32Uint));
  const auto fault_of = [&](std::string_view op, const std::vector<uint32_t>& sources) {
    lab.run_one(op, sources);
    return lab.fault ? lab.fault->what : "";
  };
  CHECK(fault_of("tex.2d.v4.u32.f32", {integers, 0, 0}).empty());
  CHECK_THAT(fault_of("tex.2d.v4.f32.f32", {integers, 0, 0}),
             Catch::Contains("reads floats") && Catch::Contains("image 0"));
  lab.image(integers).sampler.mag = Filter::Linear;
  CHECK_THAT(fault_of("tex.2d.v4.u32.f32", {integers, 0, 0}), Catch::Contains("neither filtered"));
  CHECK_THAT(fault_of("tex.3d.v4.u32.f32", {integers, 0, 0, 0}), Catch::Contains("which is 2d, as 3d"));
  CHECK_THAT(fault_of("tex.2d.v4.u32.f32", {5, 0, 0}), Catch::Contains("uses image 5"));
}

}  // namespace glint::exec
