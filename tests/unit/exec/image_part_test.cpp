// Tests views of parts of images and their swizzles, and packed formats against their names.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <cstring>

#include "tests/support/catch.h"
#include "tests/unit/exec/image_lab.h"

namespace glint::exec {
namespace {

using F = TexelFormat;
using isa::ImageShape;

uint32_t value_of(const TexelIndex& at) {
  return at.x + 10 * at.y + 100 * at.z + 1000 * at.layer + 10000 * at.level;
}

// Adds an image whose texels hold their own places.
uint32_t add_numbered(ImageLab& lab, ImageView image) {
  const uint32_t handle = lab.add(std::move(image));
  const ImageView& view = lab.image(handle);
  for (uint32_t level = 0; level < view.levels; ++level)
    for (uint32_t layer = 0; layer < view.layers; ++layer)
      for (uint32_t z = 0; z < view.extent(2, level); ++z)
        for (uint32_t y = 0; y < view.extent(1, level); ++y)
          for (uint32_t x = 0; x < view.extent(0, level); ++x) {
            const TexelIndex at{x, y, z, layer, level};
            lab.put(handle, at, {value_of(at), 0, 0, 0});
          }
  return handle;
}

// Adds a view of a part of an image and returns its handle.
uint32_t add_part(ImageLab& lab, uint32_t handle, const ImageRange& range) {
  lab.world.images.push_back(part_of(lab.image(handle), range));
  return uint32_t(lab.world.images.size() - 1);
}

// Names the fields of a packed format as its name does: the letters from the highest bits to the lowest.
struct Fields {
  std::string letters;
  std::vector<uint32_t> widths;
  explicit Fields(const std::string& name) {
    for (size_t i = 0; name[i] != '_'; ++i)
      if (std::isdigit(static_cast<unsigned char>(name[i])))
        widths.back() = widths.back() * 10 + uint32_t(name[i] - '0');
      else
        letters += name[i], widths.push_back(0);
  }
};

}  // namespace

TEST_CASE("a view of some levels and layers shows the texels of the whole image") {
  ImageLab lab;
  ImageView image;
  image.shape = ImageShape::A2d, image.format = F::R32Uint;
  image.width = 11, image.height = 6, image.layers = 5, image.levels = 4;
  const uint32_t whole = add_numbered(lab, image);
  const uint32_t part = add_part(lab, whole, {.first_level = 1, .levels = 3, .first_layer = 2, .layers = 2});
  const uint32_t inner = add_part(lab, part, {.first_level = 1, .levels = 2, .first_layer = 1, .layers = 1});
  const auto fetch = [&](uint32_t handle, uint32_t layer, uint32_t x, uint32_t y, uint32_t level) {
    return lab.run_one("tex.level.a2d.v4.u32.s32", {handle, layer, x, y, level})[0];
  };
  const uint32_t widths[] = {11, 5, 2, 1}, heights[] = {6, 3, 1, 1};
  for (uint32_t level = 0; level < 3; ++level)
    for (uint32_t layer = 0; layer < 2; ++layer)
      for (uint32_t y = 0; y < heights[level + 1]; ++y)
        for (uint32_t x = 0; x < widths[level + 1]; ++x)
          CHECK(fetch(part, layer, x, y, level) == value_of({x, y, 0, layer + 2, level + 1}));
  CHECK(fetch(inner, 0, 1, 0, 0) == value_of({1, 0, 0, 3, 2}));
  CHECK(fetch(inner, 0, 0, 0, 1) == value_of({0, 0, 0, 3, 3}));
  CHECK(lab.run_one("txq.level.width.b32", {part, 1})[0] == 2);
  CHECK(lab.run_one("txq.array_size.b32", {part})[0] == 2);
  fetch(part, 2, 0, 0, 0);
  CHECK(lab.fault);
  fetch(part, 0, 5, 0, 0);
  CHECK(lab.fault);
  fetch(part, 0, 0, 0, 3);
  CHECK(lab.fault);
}

TEST_CASE("a level of a volume and a face of a cube are views, and stores through them reach the image") {
  ImageLab lab;
  ImageView image;
  image.shape = ImageShape::D3, image.format = F::R32Uint;
  image.width = 4, image.height = 4, image.depth = 4, image.levels = 3;
  const uint32_t volume = add_numbered(lab, image);
  const uint32_t level = add_part(lab, volume, {.first_level = 1});
  CHECK(lab.run_one("tex.3d.v4.u32.s32", {level, 1, 0, 1})[0] == value_of({1, 0, 1, 0, 1}));
  lab.run_one("sust.p.3d.v4.b32.trap", {level, 0, 1, 1, 77, 0, 0, 0});
  uint32_t stored;
  std::memcpy(&stored, lab.at(volume, {0, 1, 1, 0, 1}), 4);
  CHECK(stored == 77);

  image = {};
  image.shape = ImageShape::Cube, image.format = F::R32Uint;
  image.width = image.height = 2, image.layers = 6;
  const uint32_t cube = add_numbered(lab, image);
  const uint32_t face = add_part(lab, cube, {.first_layer = 4});
  lab.image(face).shape = ImageShape::D2;
  CHECK(lab.run_one("tex.2d.v4.u32.s32", {face, 1, 1})[0] == value_of({1, 1, 0, 4, 0}));
}

TEST_CASE("a swizzle chooses what fetches, samples and gathers show") {
  ImageLab lab;
  ImageView image;
  image.format = F::Rgba32Float, image.width = image.height = 2;
  const uint32_t handle = lab.add(image);
  for (uint32_t y = 0; y < 2; ++y)
    for (uint32_t x = 0; x < 2; ++x)
      lab.put(handle, {x, y}, floats(float(x), float(10 + y), float(20 + x), float(30 + x + 2 * y)));
  lab.image(handle).swizzle = {Component::Alpha, Component::One, Component::Red, Component::Zero};
  CHECK(lab.run_one("tex.2d.v4.f32.s32", {handle, 1, 1}) == std::vector{bits(33), bits(1), bits(1), bits(0)});
  CHECK(lab.run_one("tex.2d.v4.f32.f32", {handle, bits(0.5f), bits(0.5f)}) ==
        std::vector{bits(31.5f), bits(1), bits(0.5f), bits(0)});
  CHECK(lab.run_one("tld4.r.2d.v4.f32.f32", {handle, bits(0.5f), bits(0.5f)}) ==
        std::vector{bits(32), bits(33), bits(31), bits(30)});
  CHECK(lab.run_one("tld4.g.2d.v4.f32.f32", {handle, bits(0.5f), bits(0.5f)}) ==
        std::vector{bits(1), bits(1), bits(1), bits(1)});

  image.format = F::R8Uint;
  const uint32_t integers = lab.add(image);
  lab.put(integers, {0, 0}, {9, 0, 0, 0});
  lab.image(integers).swizzle = {Component::One, Component::Red, Component::Alpha, Component::Zero};
  CHECK(lab.run_one("tex.2d.v4.u32.s32", {integers, 0, 0}) == std::vector<uint32_t>{1, 9, 1, 0});
}

TEST_CASE("every value of a packed format of 8 and 16 bits has the channels that its name says") {
  for (size_t i = 0; i < size_t(kFirstBlockFormat); ++i) {
    const F format = F(i);
    const FormatInfo& info = info_of(format);
    if (info.bits != 0 || info.bytes > 2) continue;
    INFO(info.name);
    const Fields fields{std::string(info.name)};
    for (uint32_t value = 0; value < 1u << (8 * info.bytes); ++value) {
      Words expected = floats(0, 0, 0, 1);
      uint32_t end = 8u * info.bytes;
      for (size_t f = 0; f < fields.letters.size(); ++f) {
        end -= fields.widths[f];
        const uint32_t highest = (1u << fields.widths[f]) - 1;
        expected[std::string("rgba").find(fields.letters[f])] =
            bits(float(double(value >> end & highest) / double(highest)));
      }
      std::byte bytes[2], again[2];
      std::memcpy(bytes, &value, 2);
      REQUIRE(decode(format, bytes) == expected);
      encode(format, expected, again);
      REQUIRE(std::memcmp(bytes, again, info.bytes) == 0);
    }
  }
}

TEST_CASE("Vulkan's names find the format with their bits") {
  CHECK(format_of_vulkan("VK_FORMAT_R8G8B8A8_UNORM") == F::Rgba8Unorm);
  CHECK(format_of_vulkan("A8B8G8R8_SRGB_PACK32") == F::Rgba8Srgb);
  CHECK(format_of_vulkan("B8G8R8A8_SRGB") == F::Bgra8Srgb);
  CHECK(format_of_vulkan("R16G16_SFLOAT") == F::Rg16Float);
  CHECK(format_of_vulkan("R32_SINT") == F::R32Sint);
  CHECK(format_of_vulkan("D16_UNORM") == F::R16Unorm);
  CHECK(format_of_vulkan("D32_SFLOAT") == F::R32Float);
  CHECK(format_of_vulkan("R5G6B5_UNORM_PACK16") == F::R5g6b5Pack16);
  CHECK(format_of_vulkan("A1R5G5B5_UNORM_PACK16") == F::A1r5g5b5Pack16);
  CHECK(format_of_vulkan("B4G4R4A4_UNORM_PACK16") == F::B4g4r4a4Pack16);
  CHECK(format_of_vulkan("B10G11R11_UFLOAT_PACK32") == F::R11g11b10Float);
  CHECK_FALSE(format_of_vulkan("R8G8B8_UNORM").has_value());
  CHECK_FALSE(format_of_vulkan("rgba8_unorm").has_value());
}

// The formats of which Vulkan 1.3 requires that images of them can be sampled ("Required Format Support"),
// but for compressed ones.
TEST_CASE("every format that Vulkan requires of sampled images is there") {
  const char* const required[] = {"B4G4R4A4_UNORM_PACK16",
                                  "R5G6B5_UNORM_PACK16",
                                  "A1R5G5B5_UNORM_PACK16",
                                  "B8G8R8A8_UNORM",
                                  "B8G8R8A8_SRGB",
                                  "B10G11R11_UFLOAT_PACK32",
                                  "E5B9G9R9_UFLOAT_PACK32",
                                  "D16_UNORM",
                                  "D32_SFLOAT",
                                  "A2B10G10R10_UNORM_PACK32",
                                  "A2B10G10R10_UINT_PACK32"};
  for (const char* name : required) CHECK(format_of_vulkan(name).has_value());
  for (const std::string channels : {"R8", "R8G8", "R8G8B8A8", "A8B8G8R8"})
    for (const std::string kind : {"UNORM", "SNORM", "UINT", "SINT"})
      CHECK(format_of_vulkan(channels + "_" + kind + (channels[0] == 'A' ? "_PACK32" : "")).has_value());
  CHECK(format_of_vulkan("R8G8B8A8_SRGB").has_value());
  for (const std::string bits_of_channel : {"16", "32"})
    for (const std::string channels : {"R", "RG", "RGBA"})
      for (const std::string kind : {"UINT", "SINT", "SFLOAT"}) {
        std::string name;
        for (const char c : channels) name += c + bits_of_channel;
        CHECK(format_of_vulkan(name + "_" + kind).has_value());
      }
}

}  // namespace glint::exec
