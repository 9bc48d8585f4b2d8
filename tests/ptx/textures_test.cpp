// Tests textures and surfaces of PTX kernels: shapes, coordinates, filters, and bits that move unconverted.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "tests/ptx/one_warp.h"
#include "tests/support/catch.h"

using namespace glint;

namespace {

// Holds an image whose texels are given as words.
struct Image {
  exec::TexelFormat format;
  isa::ImageShape shape;
  uint32_t width, height = 1, depth = 1, layers = 1;
  std::vector<uint32_t> words;
  exec::Sampler sampler = {};
};

struct Ran {
  std::vector<uint32_t> out, texels;
};

// Runs the kernel with the image as number 1. Image 0 is there to be left alone.
Ran run(const std::string& text, const Image& image, bool timing) {
  Launcher k(text, "test.ptx", "k");
  k.buffer(std::vector<uint32_t>(32));
  exec::ImageView view;
  view.format = image.format, view.shape = image.shape, view.sampler = image.sampler;
  view.width = image.width, view.height = image.height, view.depth = image.depth, view.layers = image.layers;
  mem::AddressSpace& memory = k.world().memory();
  view.base = memory.allocate("texels", image.words.size() * 4);
  memory.write(view.base, image.words.data(), image.words.size() * 4);
  exec::ImageView other;
  other.is_bound = false, other.name = "the other image";
  k.world().world.images = {other, view};
  if (timing) {
    k.run_timing(kWarp, {});
  } else {
    k.run_functional(kWarp);
  }
  const auto texels = memory.view<uint32_t>(view.base, image.words.size());
  return {k.read<uint32_t>(0, 32), {texels.begin(), texels.end()}};
}

void check(const std::string& body, const Image& image, uint32_t (*of_lane)(uint32_t),
           const std::vector<uint32_t>& texels_after) {
  for (const bool timing : {false, true}) {
    const Ran ran = run(storing("mov.u64 %rd1, 1; .reg .b16 %h<8>; .reg .f32 %g<12>;" + body), image, timing);
    CHECK(ran.out == expected(of_lane));
    CHECK(ran.texels == texels_after);
  }
}

std::vector<uint32_t> numbers(uint32_t count) {
  std::vector<uint32_t> out;
  for (uint32_t i = 0; i < count; ++i) out.push_back(i);
  return out;
}
std::vector<uint32_t> floats(uint32_t count) {
  std::vector<uint32_t> out;
  for (uint32_t i = 0; i < count; ++i) out.push_back(std::bit_cast<uint32_t>(float(i)));
  return out;
}

exec::Sampler texel_sampler(exec::Filter filter) {
  exec::Sampler out;
  out.mag = out.min = filter;
  out.unnormalized = true;
  return out;
}

}  // namespace

TEST_CASE("textures are read in each shape, by whole and by real coordinates") {
  using isa::ImageShape;
  const exec::Sampler nearest = texel_sampler(exec::Filter::Nearest);
  const std::string numbers_of_lane =
      "and.b32 %r1, %lane, 3; shr.u32 %r2, %lane, 2; cvt.rn.f32.u32 %f1, %r1; cvt.rn.f32.u32 %f2, %r2; "
      "add.f32 %f1, %f1, 0f3E800000; add.f32 %f2, %f2, 0f3E800000;";
  check(
      numbers_of_lane + "tex.2d.v4.u32.f32 {%out, %r3, %r4, %r5}, [%rd1, {%f1, %f2}];",
      {exec::TexelFormat::R32Uint, ImageShape::D2, 4, 8, 1, 1, numbers(32), nearest},
      [](uint32_t lane) { return lane; }, numbers(32));
  check(
      "tex.1d.v4.u32.s32 {%out, _, _, %r5}, [%rd1, {%lane}]; mad.lo.u32 %out, %r5, 100, %out;",
      {exec::TexelFormat::R32Uint, ImageShape::D1, 32, 1, 1, 1, numbers(32), nearest},
      [](uint32_t lane) { return lane + 100; }, numbers(32));
  check(
      numbers_of_lane +
          "and.b32 %r6, %r2, 1; shr.u32 %r2, %r2, 1; cvt.rn.f32.u32 %f2, %r2; "
          "tex.a2d.v4.u32.f32 {%out, %r3, %r4, %r5}, [%rd1, {%r6, %f1, %f2, %f2}];",
      {exec::TexelFormat::R32Uint, ImageShape::A2d, 4, 4, 1, 2, numbers(32), nearest},
      [](uint32_t lane) { return lane / 4 % 2 * 16 + lane / 8 * 4 + lane % 4; }, numbers(32));
  check(
      numbers_of_lane +
          "and.b32 %r6, %r2, 1; cvt.rn.f32.u32 %f3, %r6; shr.u32 %r2, %r2, 1; cvt.rn.f32.u32 %f2, %r2; "
          "tex.3d.v4.u32.f32 {%out, %r3, %r4, %r5}, [%rd1, {%f1, %f2, %f3, %f3}];",
      {exec::TexelFormat::R32Uint, ImageShape::D3, 4, 4, 2, 1, numbers(32), nearest},
      [](uint32_t lane) { return lane / 4 % 2 * 16 + lane / 8 * 4 + lane % 4; }, numbers(32));
  check(
      "txq.width.b32 %r1, [%rd1]; txq.height.b32 %r2, [%rd1]; mad.lo.u32 %out, %r1, 100, %r2;",
      {exec::TexelFormat::R32Uint, ImageShape::D2, 4, 8, 1, 1, numbers(32), nearest},
      [](uint32_t) { return 408u; }, numbers(32));
}

TEST_CASE("weights of a linear filter have eight bits where the sampler says so") {
  exec::Sampler linear = texel_sampler(exec::Filter::Linear);
  linear.weight_bits = 8;
  // The weights are a half, and a half and a thousandth, which rounds to a half.
  const std::string body =
      "setp.lt.u32 %p1, %lane, 16; mov.f32 %f1, 0f40400000; @%p1 mov.f32 %f1, 0f40401062;"
      "tex.1d.v4.f32.f32 {%f2, %f3, %f4, %f5}, [%rd1, {%f1}]; mul.f32 %f2, %f2, 0f42C80000; cvt.rni.u32.f32 "
      "%out, %f2;";
  check(
      body, {exec::TexelFormat::R32Float, isa::ImageShape::D1, 8, 1, 1, 1, floats(8), linear},
      [](uint32_t) { return 250u; }, floats(8));
}

TEST_CASE("surfaces move bits of every size, and answer for places outside as they are told") {
  using isa::ImageShape;
  // Bytes: each lane turns its four bytes round.
  std::vector<uint32_t> turned;
  for (uint32_t i = 0; i < 32; ++i) turned.push_back((i * 0x01020304u) >> 24 | 0x00aabb00u);
  std::vector<uint32_t> from;
  for (uint32_t i = 0; i < 32; ++i) from.push_back(i * 0x01020304u);
  const std::string bytes =
      "shl.b32 %r1, %lane, 2; mov.u32 %r2, 0;"
      "suld.b.2d.v4.b8.trap {%h1, %h2, %h3, %h4}, [%rd1, {%r1, %r2}]; mov.b16 %h5, 0xaa; mov.b16 %h6, 0xbb;"
      "mov.b16 %h1, 0; sust.b.2d.v4.b8.trap [%rd1, {%r1, %r2}], {%h4, %h6, %h5, %h1};"
      "suld.b.2d.b32.trap {%out}, [%rd1, {%r1, %r2}]; and.b32 %out, %out, 0xff;";
  check(
      bytes, {exec::TexelFormat::Rgba8Uint, ImageShape::D2, 32, 1, 1, 1, from},
      [](uint32_t lane) { return lane & 0xff; }, turned);
  // Pairs of 64 bits, of which the second lane's are swapped.
  const std::string wide =
      "and.b32 %r3, %lane, 7; shl.b32 %r1, %r3, 4; suld.b.1d.v2.b64.trap {%rd2, %rd3}, [%rd1, {%r1}]; "
      "cvt.u32.u64 %out, %rd3;"
      "setp.eq.u32 %p1, %lane, 1; @%p1 sust.b.1d.v2.b64.trap [%rd1, {%r1}], {%rd3, %rd2};";
  std::vector<uint32_t> swapped = numbers(32);
  swapped[4] = 6, swapped[5] = 7, swapped[6] = 4, swapped[7] = 5;
  check(
      wide, {exec::TexelFormat::Rgba32Uint, ImageShape::D1, 8, 1, 1, 1, numbers(32)},
      [](uint32_t lane) { return lane % 8 * 4 + 2; }, swapped);
  const std::string outside =
      "shl.b32 %r1, %lane, 2; add.u32 %r1, %r1, 64; mov.u32 %r2, 0;"
      "suld.b.2d.b32.zero {%out}, [%rd1, {%r1, %r2}]; add.u32 %out, %out, 5;";
  check(
      outside, {exec::TexelFormat::R32Uint, ImageShape::D2, 32, 1, 1, 1, numbers(32)},
      [](uint32_t lane) { return lane < 16 ? lane + 21 : 5; }, numbers(32));
}

TEST_CASE("mistakes in accesses of images say what is expected") {
  const auto says = [](const char* line, const char* message) {
    CAPTURE(line, message_of(storing(line)));
    CHECK(message_of(storing(line)).find(message) != std::string::npos);
  };
  says("tex.2d.v4.f32.f32 {%f1, %f2, %f3, %f4}, [%rd1, {%f1}];", "takes 2 coordinates, and there are 1");
  says("tex.2d.v4.f32.f32 {%f1, %f2, %f3}, [%rd1, {%f1, %f2}];", "takes 7 values in all, and there are 6");
  says("suld.b.2d.v4.b32.trap {%r1}, [%rd1, {%r1, %r2}];", "moves 4 values, but the operand has 1");
  says("tex.2d.v4.f32.f32 {%f1, %f2, %f3, %f4}, %rd1;", "takes a place such as [%rd1, {%f1, %f2}]");
  says("tex.9d.v4.f32.f32 {%f1, %f2, %f3, %f4}, [%rd1, {%f1, %f2}];", "no op 'tex.9d.v4.f32.f32'");
  says("istypep.texref %p1, %rd1;", "belongs to questions about handles");
}

TEST_CASE("parts of 16 bits and conversions between half formats are what PTX says") {
  CHECK(outputs(storing(".reg .b16 %h<8>; .reg .b8 %c<4>; cvt.u16.u32 %h1, %lane; mov.b16 %h2, {%c1, %c2};"
                        "mov.b16 {%c1, %c2}, 0x1234; mov.b16 %h3, {%c2, %c1}; cvt.u32.u16 %out, %h3;")) ==
        std::vector<uint32_t>(32, 0x3412));
  // 1.0 is 0x3f80 as bf16 and 0x3c00 as f16.
  CHECK(outputs(storing(
            ".reg .b16 %h<8>; mov.b16 %h1, 0x3f80; cvt.rn.f16.bf16 %h2, %h1; cvt.rn.bf16.f16 %h3, %h2;"
            "cvt.u32.u16 %r1, %h2; cvt.u32.u16 %r2, %h3; shl.b32 %r1, %r1, 16; or.b32 %out, %r1, %r2;")) ==
        std::vector<uint32_t>(32, 0x3c003f80));
}
