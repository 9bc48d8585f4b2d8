// Tests that pictures come out of files as they went in, and that damaged files end with a message.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "pictures/decode.h"
#include "pictures/encode.h"
#include "pictures/exr.h"
#include "pictures/pfm.h"
#include "tests/support/catch.h"

namespace glint::pictures {
namespace {

float float_at(const std::string& bytes, size_t at) {
  float value;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

const std::vector<float> kTwoRows{
    0.25f, 0.5f, 1.0f, 1.0f, 2.0f, -1.0f, std::numeric_limits<float>::quiet_NaN(), 0.0f};

// Returns the floats 0, 0.5, 1 and so on; all are numbers of 16 bits, too.
std::vector<float> ramp(size_t count) {
  std::vector<float> out(count);
  for (size_t i = 0; i < count; ++i) out[i] = 0.5f * float(i);
  return out;
}

DecodedPicture bytes_of(const std::string& file) {
  return decode_picture(std::span(reinterpret_cast<const uint8_t*>(file.data()), file.size()));
}

TEST_CASE("a PFM holds the bottom row first, three little-endian floats a pixel, unclamped") {
  const std::string bytes = pfm_bytes({1, 2, kTwoRows});

  const std::string header = "PF\n1 2\n-1.0\n";
  REQUIRE(bytes.size() == header.size() + 24);
  CHECK(bytes.substr(0, header.size()) == header);
  CHECK(float_at(bytes, header.size()) == 2.0f);
  CHECK(float_at(bytes, header.size() + 4) == -1.0f);
  CHECK(std::isnan(float_at(bytes, header.size() + 8)));
  CHECK(float_at(bytes, header.size() + 12) == 0.25f);
}

TEST_CASE("a PNG states its size, 8 bits and three channels in its header") {
  const std::string bytes = png_bytes({1, 2, kTwoRows});

  REQUIRE(bytes.size() > 33);
  CHECK(bytes.substr(0, 8) == "\x89PNG\r\n\x1a\n");
  CHECK(bytes.substr(16, 10) == std::string("\0\0\0\x01\0\0\0\x02\x08\x02", 10));
}

TEST_CASE("a PNG and a PFM have the same bytes at any number of threads, and read back as they were") {
  constexpr uint32_t kWidth = 500, kHeight = 401;  // The PNG has three parts that threads compress.
  std::vector<float> rgba(size_t{kWidth} * kHeight * 4);
  uint32_t state = 1;
  for (float& value : rgba) {
    state = state * 1'664'525u + 1'013'904'223u;
    value = float(state >> 24) / 255.0f;
  }
  const ImageView image{kWidth, kHeight, rgba};
  const std::string png = png_bytes(image, 1), pfm = pfm_bytes(image, 1);
  for (const uint32_t threads : {2u, 3u, 7u}) {
    CHECK(png == png_bytes(image, threads));
    CHECK(pfm == pfm_bytes(image, threads));
  }
  const DecodedPicture bytes = bytes_of(png), floats = decode_pfm(pfm);
  REQUIRE(bytes.error == "");
  REQUIRE(bytes.bytes.size() == rgba.size());
  REQUIRE(floats.floats.size() == rgba.size());
  size_t wrong = 0;
  for (size_t i = 0; i < rgba.size(); ++i) {
    const float wanted = i % 4 == 3 ? 1.0f : rgba[i];
    wrong += floats.floats[i] != wanted || float(bytes.bytes[i]) / 255.0f != wanted;
  }
  CHECK(wrong == 0);
}

TEST_CASE("a PFM of one channel or of big-endian floats is read") {
  const DecodedPicture grey = decode_pfm(std::string("Pf\n1 2\n-1\n") + std::string("\0\0\0\x40", 4) +
                                         std::string("\0\0\x80\x3f", 4));
  CHECK(grey.floats == std::vector<float>{1, 1, 1, 1, 2, 2, 2, 1});
  const DecodedPicture big = decode_pfm(std::string("Pf\n1 1\n1\n") + std::string("\x3f\x80\0\0", 4));
  CHECK(big.floats == std::vector<float>{1, 1, 1, 1});
}

TEST_CASE("an EXR reads back with every bit of its four channels") {
  for (const uint32_t width : {1u, 17u})
    for (const uint32_t height : {1u, 16u, 37u}) {  // ZIP has chunks of 16 lines.
      const std::vector<float> rgba = ramp(size_t{width} * height * 4);
      const std::string file = exr_bytes({width, height, rgba});
      CHECK(file == exr_bytes({width, height, rgba}));
      const DecodedPicture picture = decode_exr(file);
      CHECK(picture.error == "");
      CHECK(picture.width == width);
      CHECK(picture.height == height);
      CHECK(picture.floats == rgba);
    }
  const DecodedPicture odd = decode_exr(exr_bytes({1, 2, kTwoRows}));
  CHECK(std::memcmp(odd.floats.data(), kTwoRows.data(), 32) == 0);
}

TEST_CASE("floats become bytes with a gamma of 2.2 where bytes are asked for") {
  const std::vector<float> rgba{0.0f, 1.0f, 4.0f, 0.5f, -1.0f, 0.5f, 0.25f, 1.0f};
  const DecodedPicture exr = bytes_of(exr_bytes({2, 1, rgba}));
  CHECK(exr.bytes == std::vector<uint8_t>{0, 255, 255, 128, 0, 186, 136, 255});
  CHECK(exr.floats.empty());
  const DecodedPicture pfm = bytes_of(pfm_bytes({2, 1, rgba}));
  CHECK(pfm.bytes == std::vector<uint8_t>{0, 255, 255, 255, 0, 186, 136, 255});
}

// Replaces `from`, which occurs once, by `to` of the same length.
std::string changed(std::string file, const std::string& from, const std::string& to) {
  REQUIRE(from.size() == to.size());
  const size_t at = file.find(from);
  REQUIRE(at != std::string::npos);
  return file.replace(at, from.size(), to);
}

// Returns where the table of a file with three chunks begins: the first chunk follows it.
size_t table_of_three(const std::string& file) {
  for (size_t at = 8; at + 8 < file.size(); ++at) {
    uint64_t offset;
    std::memcpy(&offset, file.data() + at, 8);
    if (offset == at + 24) return at;
  }
  FAIL("there is no such table");
  return 0;
}

TEST_CASE("an EXR that is cut or damaged gives a sentence and no picture") {
  const std::string file = exr_bytes({17, 37, ramp(17 * 37 * 4)});
  for (size_t length = 4; length < file.size(); ++length) {
    const DecodedPicture picture = decode_exr(file.substr(0, length));
    CHECK(picture.error != "");
    CHECK(picture.floats.empty());
  }
  const std::string window = std::string("dataWindow\0box2i\0\x10\0\0\0\0\0\0\0\0\0\0\0", 29);
  const std::string large = std::string("dataWindow\0box2i\0\x10\0\0\0\0\0\0\0\0\0\0\x80", 29);
  CHECK(decode_exr(changed(file, window, large)).error != "");
  const std::string size = window + std::string("\x10\0\0\0\x24\0\0\0", 8);
  const std::string wide = window + std::string("\xff\x7f\0\0\xff\x7f\0\0", 8);
  CHECK(decode_exr(changed(file, size, wide)).error.find("more than is read") != std::string::npos);
  const std::string zip("compression\0compression\0\x01\0\0\0\x03", 29);
  const std::string b44("compression\0compression\0\x01\0\0\0\x06", 29);
  CHECK(decode_exr(changed(file, zip, b44)).error.find("compression") != std::string::npos);
  std::string twice = file;  // The second chunk of lines stands where the first one is wanted.
  const size_t table = table_of_three(file);
  twice.replace(table, 8, file.substr(table + 8, 8));
  CHECK(decode_exr(twice).error.find("chunks") != std::string::npos);
}

TEST_CASE("a PFM that is cut or of no size gives a sentence and no picture") {
  const std::string file = pfm_bytes({3, 2, ramp(24)});
  for (size_t length = 3; length < file.size(); ++length)
    CHECK(decode_pfm(file.substr(0, length)).error != "");
  for (const char* header : {"PF\n0 1\n-1\n", "PF\n-1 1\n-1\n", "PF\n1 1\n0\n", "PF\n1 1\nnan\n",
                             "PF\n99999999999999999999 1\n-1\n", "PF\n1 1\n-1"})
    CHECK(decode_pfm(header).error != "");
}

}  // namespace
}  // namespace glint::pictures
