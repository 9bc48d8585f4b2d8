// Tests storage images: where texels lie, what lies outside, raw bytes, atomics, and their time on a core.
// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "tests/support/catch.h"
#include "tests/unit/core/one_core.h"
#include "tests/unit/exec/image_lab.h"

namespace glint::exec {
namespace {

using core::Code, core::OneCore, core::quick_params, core::reg;

using F = TexelFormat;
using isa::ImageShape;

ImageView view(ImageShape shape, F format, uint32_t width, uint32_t height = 1, uint32_t depth = 1,
               uint32_t layers = 1) {
  ImageView out;
  out.shape = shape;
  out.format = format;
  out.width = width;
  out.height = height;
  out.depth = depth;
  out.layers = layers;
  return out;
}

uint32_t word_at(ImageLab& lab, uint32_t handle, uint64_t offset) {
  uint32_t word;
  std::memcpy(&word, lab.memory.find(lab.image(handle).base + offset, 4), 4);
  return word;
}

}  // namespace

TEST_CASE("an image is as large as its levels and layers, one after the other") {
  ImageView image = view(ImageShape::A2d, F::Rg16Float, 5, 3, 1, 2);
  image.levels = 3;
  CHECK(image.bytes() == (5 * 3 + 2 * 1 + 1 * 1) * 2 * 4);
  CHECK(image.address_of({4, 2, 0, 0, 0}) == (2 * 5 + 4) * 4);
  CHECK(image.address_of({0, 0, 0, 1, 0}) == 15 * 4);
  CHECK(image.address_of({1, 0, 0, 1, 1}) == (30 + 2 + 1) * 4);
  const ImageView volume = view(ImageShape::D3, F::R8Uint, 4, 3, 2);
  CHECK(volume.bytes() == 24);
  CHECK(volume.address_of({3, 2, 1}) == 23);
}

TEST_CASE("stored texels lie where the geometry says, and loads give them back") {
  const struct {
    ImageShape image, op;
    std::vector<uint32_t> place;  // layer and coordinates
    uint64_t texel;
  } cases[] = {{ImageShape::Buffer, ImageShape::Buffer, {7}, 7},
               {ImageShape::D1, ImageShape::D1, {7}, 7},
               {ImageShape::D2, ImageShape::D2, {3, 1}, 11},
               {ImageShape::D3, ImageShape::D3, {3, 1, 2}, 2 * 32 + 11},
               {ImageShape::A1d, ImageShape::A1d, {4, 3}, 4 * 8 + 3},
               {ImageShape::A2d, ImageShape::A2d, {4, 3, 1}, 4 * 32 + 11},
               {ImageShape::Cube, ImageShape::A2d, {5, 3, 1}, 5 * 32 + 11}};
  const std::string_view names[] = {"buffer", "1d", "2d", "3d", "a1d", "a2d"};
  for (const auto& c : cases) {
    ImageLab lab;
    const bool one = c.image == ImageShape::Buffer || c.image == ImageShape::D1 || c.image == ImageShape::A1d;
    const uint32_t handle =
        lab.add(view(c.image, F::R32Sint, 8, one ? 1 : 4, c.image == ImageShape::D3 ? 3 : 1, 6));
    const std::string name = "." + std::string(names[size_t(c.op)]) + ".v4.b32.trap";
    std::vector<uint32_t> sources{handle};
    sources.insert(sources.end(), c.place.begin(), c.place.end());
    std::vector<uint32_t> store = sources;
    store.insert(store.end(), {uint32_t(-5), 1, 2, 3});
    lab.run_one("sust.p" + name, store);
    INFO(name);
    REQUIRE(!lab.fault);
    CHECK(lab.texels.rows().size() == 1);
    CHECK(lab.texels.rows()[0][0] == lab.image(handle).base + c.texel * 4);
    CHECK(word_at(lab, handle, c.texel * 4) == uint32_t(-5));
    CHECK(lab.run_one("suld.p" + name, sources) == std::vector<uint32_t>{uint32_t(-5), 0, 0, 1});
  }
}

TEST_CASE(
    "outside of an image .trap faults, .zero reads 0 and drops stores, .clamp takes the nearest texel") {
  ImageLab lab;
  const uint32_t handle = lab.add(view(ImageShape::D2, F::R32Uint, 4, 2));
  lab.put(handle, {3, 0}, {33, 0, 0, 0});
  const std::vector<uint32_t> outside{handle, 9, uint32_t(-1)};
  std::vector<uint32_t> store = outside;
  store.insert(store.end(), {44, 0, 0, 0});
  lab.run_one("suld.p.2d.v4.b32.trap", outside);
  REQUIRE(lab.fault);
  CHECK_THAT(lab.fault->what, Catch::Contains("reads texel (9, -1, 0)"));
  lab.run_one("sust.p.2d.v4.b32.trap", store);
  REQUIRE(lab.fault);
  CHECK_THAT(lab.fault->what, Catch::Contains("writes texel"));
  CHECK(lab.run_one("suld.p.2d.v4.b32.zero", outside) == std::vector<uint32_t>{0, 0, 0, 0});
  lab.run_one("sust.p.2d.v4.b32.zero", store);
  CHECK(word_at(lab, handle, 12) == 33);
  CHECK(lab.run_one("suld.p.2d.v4.b32.clamp", outside)[0] == 33);
  lab.run_one("sust.p.2d.v4.b32.clamp", store);
  CHECK(word_at(lab, handle, 12) == 44);
  lab.world.robust_images = true;
  CHECK(lab.run_one("suld.p.2d.v4.b32.trap", outside) == std::vector<uint32_t>{0, 0, 0, 1});
  CHECK(!lab.fault);
}

TEST_CASE("a fault stores nothing, not even for the lanes before it") {
  ImageLab lab;
  const uint32_t handle = lab.add(view(ImageShape::D1, F::R32Uint, 16));
  ImageLab::Column x;
  for (size_t lane = 0; lane < kLanes; ++lane) x[lane] = uint32_t(lane);
  lab.run("sust.p.1d.v4.b32.trap", {lab.all(handle), x, lab.all(7u), lab.all(0u), lab.all(0u), lab.all(0u)});
  REQUIRE(lab.fault);
  CHECK(lab.fault->launch_id[0] == 16);
  CHECK(word_at(lab, handle, 0) == 0);
}

TEST_CASE("suld.b and sust.b move bytes as they are and count x in bytes") {
  ImageLab lab;
  const uint32_t handle = lab.add(view(ImageShape::D2, F::Rgba8Unorm, 4, 2));
  lab.run_one("sust.b.2d.v2.b32.trap", {handle, 8, 1, 0x0403'0201, 0x0807'0605});
  CHECK(word_at(lab, handle, 24) == 0x0403'0201);
  CHECK(word_at(lab, handle, 28) == 0x0807'0605);
  CHECK(lab.run_one("suld.b.2d.b8.trap", {handle, 13, 1})[0] == 6);
  CHECK(lab.run_one("suld.b.2d.b16.trap", {handle, 14, 1})[0] == 0x0807);
  CHECK(lab.run_one("suld.b.2d.b32.trap", {handle, 8, 1})[0] == 0x0403'0201);
  CHECK(lab.run_one("suld.b.2d.v4.b32.trap", {handle, 0, 1}) ==
        std::vector<uint32_t>{0, 0, 0x0403'0201, 0x0807'0605});
  lab.run_one("suld.b.2d.b32.trap", {handle, 13, 1});
  CHECK(lab.fault);  // the address is not aligned
  lab.run_one("suld.b.2d.b32.trap", {handle, 16, 1});
  CHECK(lab.fault);  // the address is past the row
  CHECK(lab.run_one("suld.b.2d.v2.b32.clamp", {handle, 104, 1}) ==
        std::vector<uint32_t>{0x0403'0201, 0x0807'0605});
  lab.run_one("sust.b.2d.b8.trap", {handle, 0, 0, 0x1ff});
  CHECK(word_at(lab, handle, 0) == 0xff);
}

TEST_CASE("32 lanes that change one texel take turns, the lowest first") {
  ImageLab lab;
  const uint32_t handle = lab.add(view(ImageShape::D2, F::R32Uint, 4, 4));
  const std::vector<ImageLab::Column> place{lab.all(handle), lab.all(2u), lab.all(3u)};
  ImageLab::Column lanes;
  for (size_t lane = 0; lane < kLanes; ++lane) lanes[lane] = uint32_t(lane);
  const auto run = [&](std::string_view op, uint32_t start, const ImageLab::Column& operand) {
    lab.put(handle, {2, 3}, {start, 0, 0, 0});
    std::vector<ImageLab::Column> sources = place;
    sources.push_back(operand);
    const auto old = lab.run(op, sources);
    REQUIRE(!lab.fault);
    return std::array<uint32_t, 4>{old[0][0], old[0][1], old[0][31], word_at(lab, handle, 14 * 4)};
  };
  using Result = std::array<uint32_t, 4>;  // old values of lanes 0, 1 and 31, and what stays
  CHECK(run("suatom.p.add.2d.u32.trap", 5, lab.all(1u)) == Result{5, 6, 36, 37});
  CHECK(run("suatom.p.add.2d.s32.trap", 5, lanes) == Result{5, 5, 470, 501});
  CHECK(run("suatom.p.min.2d.u32.trap", ~0u, lanes) == Result{~0u, 0, 0, 0});
  CHECK(run("suatom.p.min.2d.s32.trap", ~0u, lanes) == Result{~0u, ~0u, ~0u, ~0u});
  CHECK(run("suatom.p.max.2d.u32.trap", 3, lanes) == Result{3, 3, 30, 31});
  CHECK(run("suatom.p.max.2d.s32.trap", ~0u, lanes) == Result{~0u, 0, 30, 31});
  CHECK(run("suatom.p.and.2d.b32.trap", 0xff, lanes) == Result{0xff, 0, 0, 0});
  CHECK(run("suatom.p.or.2d.b32.trap", 0x40, lanes) == Result{0x40, 0x40, 0x5f, 0x5f});
  CHECK(run("suatom.p.xor.2d.b32.trap", 0, lanes) == Result{0, 0, 31, 0});
  CHECK(run("suatom.p.exch.2d.b32.trap", 77, lanes) == Result{77, 0, 30, 31});
  lab.image(handle).format = F::R32Float;
  CHECK(run("suatom.p.add.2d.f32.trap", bits(0.5f), lab.all(0.25f)) ==
        Result{bits(0.5f), bits(0.75f), bits(8.25f), bits(8.5f)});
}

TEST_CASE("compare and swap changes a texel for the lane that expects its value only") {
  ImageLab lab;
  const uint32_t handle = lab.add(view(ImageShape::Buffer, F::R32Sint, 8));
  ImageLab::Column expected, swap;
  for (size_t lane = 0; lane < kLanes; ++lane)
    expected[lane] = uint32_t(lane), swap[lane] = uint32_t(lane + 1);
  const auto old = lab.run("suatom.p.cas.buffer.b32.trap", {lab.all(handle), lab.all(3u), expected, swap});
  CHECK(old[0] == expected);
  CHECK(word_at(lab, handle, 12) == 32);
}

TEST_CASE("reductions count x in bytes and give nothing back") {
  ImageLab lab;
  const uint32_t handle = lab.add(view(ImageShape::D1, F::R32Uint, 8));
  lab.run_one("sured.b.add.1d.u32.trap", {handle, 4, 2});
  CHECK(word_at(lab, handle, 4) == 64);
  lab.run_one("sured.b.max.1d.s32.zero", {handle, 99 * 4, 2});
  CHECK(!lab.fault);
}

TEST_CASE("an atomic on a format that is not one word of 32 bits is a fault") {
  ImageLab lab;
  const uint32_t handle = lab.add(view(ImageShape::D1, F::Rgba8Uint, 8));
  lab.run_one("suatom.p.add.1d.u32.trap", {handle, 0, 1});
  REQUIRE(lab.fault);
  CHECK_THAT(lab.fault->what, Catch::Contains("rgba8_uint"));
}

TEST_CASE("a core charges image ops for the lines they touch, and none when all texels are border") {
  for (const bool border : {false, true}) {
    Code code;
    code.add("tex.1d.v4.f32.f32",
             {reg(1), reg(2), reg(3), reg(4), code.constant(0), code.constant(bits(border ? 9.0f : 0.5f))});
    code.add("txq.width.b32", {reg(5), code.constant(0)});
    code.add("suatom.p.add.1d.u32.trap", {reg(6), code.constant(1), code.constant(1), reg(5)});
    code.add("add.u32", {reg(7), reg(4), reg(6)});
    code.add("exit");
    OneCore core(code, quick_params(), {});
    const Address at = core.memory.allocate("image", 64), counters = core.memory.allocate("counters", 64);
    ImageView texture = view(ImageShape::D1, F::R32Float, 16);
    texture.base = at;
    texture.sampler.wrap.fill(Wrap::ClampToBorder);
    ImageView counter = view(ImageShape::D1, F::R32Uint, 16);
    counter.base = counters;
    core.world.images = {texture, counter};
    core.run();
    CHECK(!core.cell->fault());
    CHECK(core.stats().lines.value() == (border ? 1u : 2u));
    CHECK(core.stats().texture_fetches.value() == (border ? 0u : 1u));
    CHECK(core.memory.view<uint32_t>(counters, 2)[1] == 32 * 16);
  }
}

}  // namespace glint::exec
