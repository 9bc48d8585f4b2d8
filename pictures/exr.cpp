// Calls tinyexr, after it has made sure of what tinyexr takes for granted.
// SPDX-License-Identifier: Apache-2.0
#include "pictures/exr.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fmt/format.h>
#include <memory>
#include <set>
#include <tinyexr.h>
#include <vector>

#include "base/check.h"

namespace glint::pictures {
namespace {

constexpr std::string_view kExrMagic("\x76\x2f\x31\x01", 4);
constexpr size_t kVersionBytes = 8;  // the magic number and the version
// Deflate makes at most 1032 bytes from one, and RLE fewer. PIZ has no such limit.
constexpr uint64_t kLargestRatio = 1100;

// Holds what tinyexr allocates for a file, and frees it.
struct Loaded {
  EXRHeader header;
  EXRImage image;
  Loaded() { InitEXRHeader(&header), InitEXRImage(&image); }
  ~Loaded() { FreeEXRImage(&image), FreeEXRHeader(&header); }
  Loaded(const Loaded&) = delete;
  Loaded& operator=(const Loaded&) = delete;
  int64_t width() const { return int64_t{header.data_window.max_x} - header.data_window.min_x + 1; }
  int64_t height() const { return int64_t{header.data_window.max_y} - header.data_window.min_y + 1; }
};

// Returns tinyexr's message, and frees it.
std::string message_of(const char* message) {
  if (!message) return "the file is damaged";
  std::string out(message);
  FreeEXRErrorMessage(message);
  while (!out.empty() && (out.back() == '\n' || out.back() == '.')) out.pop_back();
  return out;
}

const unsigned char* exr_data(std::string_view file) {
  return reinterpret_cast<const unsigned char*>(file.data());
}

template <class T>
T number_at(std::string_view file, uint64_t at) {
  T value;
  std::memcpy(&value, file.data() + at, sizeof value);
  return value;
}

static_assert(std::endian::native == std::endian::little,
              "EXR files are little-endian, and are read as such");

// Returns the lines that lie in one chunk.
int64_t lines_of_chunk(int compression) {
  return compression == TINYEXR_COMPRESSIONTYPE_ZIP   ? 16
         : compression == TINYEXR_COMPRESSIONTYPE_PIZ ? 32
                                                      : 1;
}

// Returns what is wrong with the attributes of a file's header, or "". Each has a name, a type, a length of 4
// bytes, and its value; an empty name ends them. tinyexr asserts what is looked for here.
std::string wrong_with_attributes(std::string_view file, bool is_tiled) {
  std::set<std::string_view> seen;
  const auto next_text = [&](size_t& at) {
    const size_t end = std::min(file.find('\0', at), file.size());
    const std::string_view text = file.substr(at, end - at);
    at = std::min(end + 1, file.size());
    return text;
  };
  for (size_t at = kVersionBytes;;) {
    const std::string_view name = next_text(at);
    if (name.empty()) return "";
    next_text(at);  // the type
    if (file.size() - at < 4) return "the header is cut short";
    const auto size = number_at<uint32_t>(file, at);
    if (size > file.size() - at - 4) return "the header is cut short";
    const std::string_view value = file.substr(at + 4, size);
    at += 4 + size;
    if (!seen.insert(name).second) return fmt::format("the header has '{}' twice", name);
    if (name == "tiles" && (size != 9 || (value[8] & 3) != TINYEXR_TILE_ONE_LEVEL))
      return "tiles of several levels are not read";
    if (name == "type" && value != (is_tiled ? "tiledimage" : "scanlineimage"))
      return "pictures of this type are not read";
    if (name == "compression" && (size != 1 || uint8_t(value[0]) > TINYEXR_COMPRESSIONTYPE_PIZ))
      return "its compression is not read; expected none, RLE, ZIPS, ZIP or PIZ";
  }
}

// Returns what is wrong with the size or the channels that a header states, or "".
std::string wrong_with_header(const Loaded& loaded, std::string_view file) {
  const EXRHeader& header = loaded.header;
  if (loaded.width() < 1 || loaded.height() < 1 || std::max(loaded.width(), loaded.height()) > kMostPixels)
    return fmt::format("it has {}x{} pixels, and 1 to {} in a row or column are read", loaded.width(),
                       loaded.height(), kMostPixels);
  if (header.num_channels < 1) return "it has no channels";
  const auto bytes = uint64_t(loaded.width() * loaded.height()) * uint64_t(header.num_channels) * 4;
  if (bytes > kMostBytes ||
      (header.compression_type != TINYEXR_COMPRESSIONTYPE_PIZ && bytes / kLargestRatio > file.size()))
    return fmt::format("the header states {} bytes of pixels, which is more than {}", bytes,
                       bytes > kMostBytes ? "is read" : "the file can hold");
  for (int c = 0; c < header.num_channels; ++c)
    if (header.pixel_types[c] < TINYEXR_PIXELTYPE_UINT || header.pixel_types[c] > TINYEXR_PIXELTYPE_FLOAT ||
        header.channels[c].x_sampling != 1 || header.channels[c].y_sampling != 1)
      return fmt::format("its channel '{}' does not have one number of a known kind per pixel",
                         header.channels[c].name);
  if (header.tiled &&
      (header.tile_size_x < 1 || header.tile_size_y < 1 || header.tile_size_x > kMostPixels ||
       header.tile_size_y > kMostPixels ||
       uint64_t(header.tile_size_x) * uint64_t(header.tile_size_y) * 4 * uint64_t(header.num_channels) >
           kMostBytes))
    return fmt::format("it has tiles of {}x{} pixels", header.tile_size_x, header.tile_size_y);
  return "";
}

// Returns the numbers that begin chunk `i`: its first line, or its tile's column, row, and levels.
std::vector<int64_t> place_of_chunk(const Loaded& loaded, uint64_t i) {
  const EXRHeader& header = loaded.header;
  if (!header.tiled) return {header.data_window.min_y + int64_t(i) * lines_of_chunk(header.compression_type)};
  const uint64_t columns = uint64_t((loaded.width() - 1) / header.tile_size_x + 1);
  return {int64_t(i % columns), int64_t(i / columns), 0, 0};
}

uint64_t chunks_of(const Loaded& loaded) {
  const EXRHeader& header = loaded.header;
  if (!header.tiled) return uint64_t((loaded.height() - 1) / lines_of_chunk(header.compression_type) + 1);
  return uint64_t((loaded.width() - 1) / header.tile_size_x + 1) *
         uint64_t((loaded.height() - 1) / header.tile_size_y + 1);
}

// Returns what is wrong with the table of chunks, or "". Every chunk must hold the lines or the tile of its
// place, because pixels of others would keep what the memory held before.
std::string wrong_with_chunks(const Loaded& loaded, std::string_view file) {
  const uint64_t chunks = chunks_of(loaded), table = kVersionBytes + loaded.header.header_len;
  if (loaded.header.chunk_count > 0 && uint64_t(loaded.header.chunk_count) != chunks)
    return "the number of its chunks is not that of its pixels";
  if (table + chunks * 8 > file.size()) return "the file is cut short";
  for (uint64_t i = 0; i < chunks; ++i) {
    auto at = number_at<uint64_t>(file, table + i * 8);
    const std::vector<int64_t> place = place_of_chunk(loaded, i);
    const uint64_t head = 4 * place.size() + 4;
    if (at < table + chunks * 8 || at > file.size() || file.size() - at < head)
      return "the file is cut short, or its table of chunks is damaged";
    for (const int64_t number : place) {
      if (number_at<int32_t>(file, at) != number) return "its table of chunks is damaged";
      at += 4;
    }
    const int64_t length = number_at<int32_t>(file, at);
    if (length < 0 || uint64_t(length) > file.size() - at - 4) return "the file is cut short";
  }
  return "";
}

// Loads a file. Returns why that cannot be done, or "".
std::string load_exr(Loaded& loaded, std::string_view file) {
  EXRVersion version{};
  if (ParseEXRVersionFromMemory(&version, exr_data(file), file.size()) != TINYEXR_SUCCESS)
    return "its version cannot be read";
  if (version.multipart || version.non_image) return "files of several parts and deep pictures are not read";
  if (const std::string wrong = wrong_with_attributes(file, version.tiled != 0); !wrong.empty()) return wrong;
  const char* message = nullptr;
  if (ParseEXRHeaderFromMemory(&loaded.header, &version, exr_data(file), file.size(), &message) !=
      TINYEXR_SUCCESS)
    return message_of(message);
  if (const std::string wrong = wrong_with_header(loaded, file); !wrong.empty()) return wrong;
  if (const std::string wrong = wrong_with_chunks(loaded, file); !wrong.empty()) return wrong;
  for (int c = 0; c < loaded.header.num_channels; ++c)
    if (loaded.header.pixel_types[c] == TINYEXR_PIXELTYPE_HALF)
      loaded.header.requested_pixel_types[c] = TINYEXR_PIXELTYPE_FLOAT;
  loaded.image.num_channels = loaded.header.num_channels;  // Otherwise a failure frees no channel.
  if (LoadEXRImageFromMemory(&loaded.image, &loaded.header, exr_data(file), file.size(), &message) ==
      TINYEXR_SUCCESS)
    return "";
  InitEXRImage(&loaded.image);  // tinyexr has freed what it had allocated, but still refers to it.
  return message_of(message);
}

// Returns which channel of the file each of red, green, blue and alpha is, or -1.
std::array<int, 4> channels_of(const EXRHeader& header) {
  const auto named = [&](std::string_view name) {
    for (int c = 0; c < header.num_channels; ++c)
      if (header.channels[c].name == name) return c;
    return -1;
  };
  std::array<int, 4> out = {named("R"), named("G"), named("B"), named("A")};
  if (out[0] >= 0 || out[1] >= 0 || out[2] >= 0) return out;
  const int grey = header.num_channels == 1 ? 0 : named("Y");
  return {grey, grey, grey, header.num_channels == 1 ? -1 : out[3]};
}

// Copies one block of pixels, a whole picture or a tile, to its place.
void copy_block(const Loaded& loaded, unsigned char** images, const std::array<int, 4>& channels, int64_t x0,
                int64_t y0, int64_t width, int64_t height, int64_t stride, DecodedPicture& out) {
  for (size_t c = 0; c < 4; ++c) {
    const int channel = channels[c];
    if (channel < 0) continue;
    const bool is_whole = loaded.header.pixel_types[channel] == TINYEXR_PIXELTYPE_UINT;
    for (int64_t y = 0; y < std::min(height, int64_t{out.height} - y0); ++y)
      for (int64_t x = 0; x < std::min(width, int64_t{out.width} - x0); ++x) {
        uint32_t word;
        std::memcpy(&word, images[channel] + (y * stride + x) * 4, sizeof word);
        out.floats[size_t((y0 + y) * out.width + x0 + x) * 4 + c] =
            is_whole ? float(word) : std::bit_cast<float>(word);
      }
  }
}

DecodedPicture picture_of(const Loaded& loaded) {
  DecodedPicture out;
  const EXRHeader& header = loaded.header;
  const std::array<int, 4> channels = channels_of(header);
  if (channels[0] < 0 && channels[1] < 0 && channels[2] < 0) {
    std::string names;
    for (int c = 0; c < header.num_channels; ++c)
      names += std::string(c ? ", " : "") + header.channels[c].name;
    out.error = fmt::format("it has the channels {}; expected R, G and B, or Y, or one only", names);
    return out;
  }
  out.width = uint32_t(loaded.width()), out.height = uint32_t(loaded.height());
  out.floats.resize(size_t(out.width) * out.height * 4);
  for (size_t i = 3; i < out.floats.size(); i += 4) out.floats[i] = 1;
  if (!header.tiled) {
    copy_block(loaded, loaded.image.images, channels, 0, 0, out.width, out.height, out.width, out);
    return out;
  }
  for (int t = 0; t < loaded.image.num_tiles; ++t) {
    const EXRTile& tile = loaded.image.tiles[t];
    if (!tile.images || tile.offset_x < 0 || tile.offset_y < 0) continue;
    copy_block(loaded, tile.images, channels, int64_t{tile.offset_x} * header.tile_size_x,
               int64_t{tile.offset_y} * header.tile_size_y, tile.width, tile.height, header.tile_size_x, out);
  }
  return out;
}

}  // namespace

bool is_exr(std::string_view file) {
  return file.substr(0, kExrMagic.size()) == kExrMagic;
}

DecodedPicture decode_exr(std::string_view file) {
  DecodedPicture out;
  try {
    Loaded loaded;
    out.error = load_exr(loaded, file);
    if (out.error.empty()) return picture_of(loaded);
  } catch (const std::exception&) {  // A damaged length ends in std::length_error or std::bad_alloc.
    out.error = "the file is damaged";
  }
  return out;
}

std::string exr_bytes(const ImageView& image) {
  const size_t pixels = size_t{image.width} * image.height;
  GLINT_CHECK_EQ(image.rgba.size(), pixels * 4);
  constexpr std::string_view kNames = "ABGR";  // Channels stand in the order of their names.
  std::vector<float> planes(pixels * 4);
  for (size_t c = 0; c < 4; ++c)
    for (size_t i = 0; i < pixels; ++i) planes[c * pixels + i] = image.rgba[i * 4 + (3 - c)];
  std::array<unsigned char*, 4> images;
  std::array<EXRChannelInfo, 4> channels{};
  std::array<int, 4> types;
  types.fill(TINYEXR_PIXELTYPE_FLOAT);
  for (size_t c = 0; c < 4; ++c) {
    images[c] = reinterpret_cast<unsigned char*>(planes.data() + c * pixels);
    channels[c].name[0] = kNames[c];
  }
  EXRHeader header;
  InitEXRHeader(&header);
  header.num_channels = 4, header.channels = channels.data();
  header.pixel_types = types.data(), header.requested_pixel_types = types.data();
  header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
  EXRImage source;
  InitEXRImage(&source);
  source.num_channels = 4, source.images = images.data();
  source.width = int(image.width), source.height = int(image.height);
  unsigned char* bytes = nullptr;
  const char* message = nullptr;
  const size_t size = SaveEXRImageToMemory(&source, &header, &bytes, &message);
  GLINT_CHECK(size != 0, "the EXR encoder refused a {}x{} image: {}", image.width, image.height,
              message_of(message));
  const std::unique_ptr<unsigned char, void (*)(void*)> holder(bytes, std::free);
  return {reinterpret_cast<const char*>(bytes), size};
}

}  // namespace glint::pictures
