// Tests the blocks of BC1 to BC7 against values by hand, the specification's example, and sums of what other
// decoders make of them.
// SPDX-License-Identifier: Apache-2.0
#include "exec/block_formats.h"

#include <cstring>
#include <vector>

#include "exec/block_bits.h"
#include "tests/support/catch.h"
#include "tests/unit/exec/image_lab.h"

namespace glint::exec {
namespace {

using F = TexelFormat;
using TexelBlock = std::array<std::byte, 16>;

TexelBlock block_of(uint64_t low, uint64_t high = 0) {
  const uint64_t words[] = {low, high};
  TexelBlock out;
  std::memcpy(out.data(), words, sizeof words);
  return out;
}
// Returns a block whose first 16 bits are two bytes, and whose codes of 3 bits count from 0 to 7 again and
// again.
uint64_t counting(uint8_t first, uint8_t second) {
  uint64_t bits = first | uint64_t{second} << 8;
  for (uint64_t texel = 0; texel < 16; ++texel) bits |= texel % 8 << (16 + 3 * texel);
  return bits;
}
float red(F format, const TexelBlock& block, uint32_t texel) {
  return number(decode_block(format, block.data(), texel)[0]);
}

// Red is the first end and blue the second, in whichever order, and texel i of a row has code i.
constexpr uint64_t kRed = 0xf800, kBlue = 0x001f, kCodes = uint64_t{0b11100100} << 32;

uint64_t next(uint64_t& state) {
  state ^= state << 13, state ^= state >> 7, state ^= state << 17;
  return state;
}
// Holds an FNV-1a sum of bytes.
class Sum {
 public:
  void add(uint32_t byte) { value_ = (value_ ^ byte) * 0x100'0000'01b3ull; }
  uint64_t value() const { return value_; }

 private:
  uint64_t value_ = 0xcbf2'9ce4'8422'2325ull;
};

}  // namespace

TEST_CASE("a block of BC1 has two colours between its ends, or one and black") {
  const TexelBlock four = block_of(kRed | kBlue << 16 | kCodes),
                   three = block_of(kBlue | kRed << 16 | kCodes);
  const auto texel = [](F format, const TexelBlock& block, uint32_t at) {
    return decode_block(format, block.data(), at);
  };

  CHECK(texel(F::Bc1RgbaUnorm, four, 0) == floats(1, 0, 0, 1));
  CHECK(texel(F::Bc1RgbaUnorm, four, 1) == floats(0, 0, 1, 1));
  CHECK(texel(F::Bc1RgbaUnorm, four, 2) == floats(2 / 3.0f, 0, 1 / 3.0f, 1));
  CHECK(texel(F::Bc1RgbaUnorm, four, 3) == floats(1 / 3.0f, 0, 2 / 3.0f, 1));
  CHECK(texel(F::Bc1RgbaUnorm, four, 4) == floats(1, 0, 0, 1));
  CHECK(texel(F::Bc1RgbaUnorm, three, 2) == floats(0.5f, 0, 0.5f, 1));
  CHECK(texel(F::Bc1RgbaUnorm, three, 3) == floats(0, 0, 0, 0));
  CHECK(texel(F::Bc1RgbUnorm, three, 3) == floats(0, 0, 0, 1));
  CHECK(number(texel(F::Bc1RgbSrgb, four, 2)[0]) == float(linear_of_srgb(2 / 3.0)));
}

TEST_CASE("blocks of BC2 and BC3 have four colours whatever the order of their ends") {
  const uint64_t colours = kBlue | kRed << 16 | kCodes;
  const TexelBlock explicit_alpha = block_of(0xfedc'ba98'7654'3210, colours);
  const TexelBlock alpha_between = block_of(counting(70, 0), colours);

  for (uint32_t i = 0; i < 16; ++i)
    CHECK(number(decode_block(F::Bc2Unorm, explicit_alpha.data(), i)[3]) == float(i) / 15.0f);
  CHECK(decode_block(F::Bc2Unorm, explicit_alpha.data(), 3) == floats(2 / 3.0f, 0, 1 / 3.0f, 3 / 15.0f));
  CHECK(number(decode_block(F::Bc3Unorm, alpha_between.data(), 3)[3]) == 50 / 255.0f);
  CHECK(number(decode_block(F::Bc3Srgb, alpha_between.data(), 3)[3]) == 50 / 255.0f);
  CHECK(number(decode_block(F::Bc3Unorm, alpha_between.data(), 3)[0]) == 2 / 3.0f);
}

TEST_CASE("a block of BC4 has six values between its ends, or four and the two extremes") {
  const TexelBlock six = block_of(counting(70, 0)), four = block_of(counting(0, 50));
  const int between_six[] = {70, 0, 60, 50, 40, 30, 20, 10}, between_four[] = {0, 50, 10, 20, 30, 40, 0, 255};

  for (uint32_t i = 0; i < 16; ++i) {
    CHECK(red(F::Bc4Unorm, six, i) == float(between_six[i % 8]) / 255.0f);
    CHECK(red(F::Bc4Unorm, four, i) == float(between_four[i % 8]) / 255.0f);
  }
  const Words both = decode_block(F::Bc5Unorm, block_of(counting(70, 0), counting(0, 50)).data(), 2);
  CHECK(both == floats(60 / 255.0f, 10 / 255.0f, 0, 1));
}

TEST_CASE("a signed block of BC4 reaches from -1 to 1, and -128 is -1 too") {
  const TexelBlock falling = block_of(counting(70, uint8_t(-70))),
                   rising = block_of(counting(uint8_t(-128), 122));

  CHECK(red(F::Bc4Snorm, falling, 2) == 50 / 127.0f);
  CHECK(red(F::Bc4Snorm, falling, 7) == -50 / 127.0f);
  CHECK(red(F::Bc4Snorm, rising, 0) == -1.0f);
  CHECK(red(F::Bc4Snorm, rising, 2) == float((4 * -127 + 122) / (5 * 127.0)));
  CHECK(red(F::Bc4Snorm, rising, 6) == -1.0f);
  CHECK(red(F::Bc4Snorm, rising, 7) == 1.0f);
}

TEST_CASE("the specification's example of a block of BC7 finds its index in bits 115 and 116") {
  // Mode 2 with partition 6: texel (1, 2) belongs to the second subset.
  const BlockSubsets subsets{3, 6};
  CHECK(subsets.of(9) == 1);
  CHECK(subsets.anchor(1) == 15);
  CHECK(subsets.anchor(2) == 3);
  const BlockBits bits(block_of(0, uint64_t{2} << (115 - 64)).data());
  CHECK(block_weight(bits, subsets, 9, 99, 2) == 43);
}

TEST_CASE("the anchors of each partition lie in their subsets") {
  for (uint32_t count = 2; count <= 3; ++count)
    for (uint32_t partition = 0; partition < 64; ++partition)
      for (uint32_t subset = 0; subset < count; ++subset) {
        const BlockSubsets subsets{count, partition};
        REQUIRE(subsets.of(subsets.anchor(subset)) == subset);
      }
}

// The sum is that of Pillow 9.4's decoder, and every byte of its pictures was compared.
TEST_CASE("each mode and partition of BC7 has the bytes that another decoder gives") {
  uint64_t state = 88172645463325252ull;
  Sum sum;
  for (uint32_t mode = 0; mode < 8; ++mode)
    for (uint64_t partition = 0; partition < 64; ++partition) {
      uint64_t low = next(state);
      const uint64_t high = next(state);
      low = low >> (mode + 1) << (mode + 1) | uint64_t{1} << mode;
      if (mode < 4 || mode == 7) {
        const uint64_t mask = mode == 0 ? 15 : 63;
        low = (low & ~(mask << (mode + 1))) | (partition & mask) << (mode + 1);
      }
      for (uint32_t texel = 0; texel < 16; ++texel)
        for (uint8_t byte : decode_bc7(block_of(low, high).data(), texel)) sum.add(byte);
    }
  CHECK(sum.value() == 0xf0df'7a38'7bc8'e06e);
}

// The sums are those of lavapipe 22.3's decoder, and every half of its images was compared.
TEST_CASE("each mode and partition of BC6H has the bits that another decoder gives") {
  for (const auto& [is_signed, expected] :
       {std::pair{false, 0xb8ea'0b66'f686'0c7bull}, {true, 0x1938'17ea'fb93'78dbull}}) {
    uint64_t state = 362436069;
    Sum sum;
    for (const uint64_t mode : {0, 1, 2, 6, 10, 14, 18, 22, 26, 30, 3, 7, 11, 15})
      for (uint64_t partition = 0; partition < 32; ++partition) {
        const uint64_t random = next(state);
        uint64_t high = next(state);
        const int width = mode < 2 ? 2 : 5;
        if ((mode & 3) != 3) high = (high & ~(uint64_t{31} << 13)) | partition << 13;
        const TexelBlock block = block_of(random >> width << width | mode, high);
        for (uint32_t texel = 0; texel < 16; ++texel)
          for (uint16_t half : decode_bc6h(block.data(), texel, is_signed))
            sum.add(half & 0xff), sum.add(half >> 8);
      }
    CHECK(sum.value() == expected);
  }
}

TEST_CASE("reserved modes are black, and transparent where the format has alpha") {
  for (const uint64_t mode : {19, 23, 27, 31})
    CHECK(decode_block(F::Bc6hUfloat, block_of(mode | ~uint64_t{31}, ~uint64_t{0}).data(), 5) ==
          floats(0, 0, 0, 1));
  CHECK(decode_block(F::Bc7Unorm, block_of(~uint64_t{255}, ~uint64_t{0}).data(), 5) == floats(0, 0, 0, 0));
}

TEST_CASE("an image with blocks has whole blocks at its ends, and each texel finds its own") {
  ImageLab lab;
  ImageView image = view_of(isa::ImageShape::D2, 6, 5, 1, F::Bc4Unorm);
  image.levels = 3, image.layers = 2;
  // Levels of 6 x 5, 3 x 2 and 1 x 1 texels have 2 x 2, 1 and 1 blocks.
  CHECK(image.bytes() == (4 + 1 + 1) * 2 * 8);
  const uint32_t handle = lab.add(image);
  const Address base = lab.image(handle).base;
  CHECK(lab.image(handle).address_of({5, 4, 0, 1, 0}) == base + (4 + 3) * 8);
  CHECK(lab.image(handle).address_of({2, 1, 0, 1, 1}) == base + (8 + 1) * 8);
  const uint64_t block = counting(70, 0);
  std::memcpy(lab.at(handle, {5, 0, 0, 0, 0}), &block, sizeof block);

  const auto texel = [&](uint32_t x, uint32_t y) {
    return number(lab.run_one("tex.level.2d.v4.f32.s32", {handle, x, y, 0})[0]);
  };
  CHECK(texel(4, 0) == 70 / 255.0f);
  CHECK(texel(5, 1) == 30 / 255.0f);
  CHECK(texel(3, 0) == 0.0f);
  CHECK(lab.texels.rows().size() == 1);
}

TEST_CASE("a store to an image with blocks is a fault") {
  ImageLab lab;
  const uint32_t handle = lab.add(view_of(isa::ImageShape::D2, 4, 4, 1, F::Bc7Unorm));
  lab.run_one("sust.p.2d.v4.b32.trap", {handle, 0, 0, 0, 0, 0, 0});
  REQUIRE(lab.fault);
  CHECK(lab.fault->what.find("bc7_unorm_block can only be sampled") != std::string::npos);
}

}  // namespace glint::exec
