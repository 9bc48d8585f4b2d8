// Reads picture files and encodes texels.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/description/pictures.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <optional>
#include <utility>

#include "base/parallel_ranges.h"
#include "pictures/decode.h"
#include "pipeline/description/data.h"

namespace glint::pipeline {
namespace {

using exec::TexelFormat;
using isa::ImageShape;
using Texel = std::array<double, 4>;  // floats, or integers when the format has them

constexpr size_t kTexelsOfRange = 1 << 14;  // texels that a thread converts at a time

// Converts encoded values of sRGB files to the linear ones that the format's encode() takes (IEC 61966-2-1).
double to_linear(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

// Holds what the bytes of a file stand for: values of 0 to 1, or integers if the format keeps them.
struct ByteValues {
  std::array<double, 256> color, alpha;
  explicit ByteValues(const exec::FormatInfo& info) {
    for (size_t byte = 0; byte < color.size(); ++byte) {
      alpha[byte] = exec::is_integer(info) ? double(byte) : double(byte) * (1.0 / 255);
      color[byte] = info.numeric == exec::Numeric::Srgb ? to_linear(alpha[byte]) : alpha[byte];
    }
  }
};

// Returns whether texels of a format are the four bytes that pictures have.
bool keeps_bytes(TexelFormat format) {
  return format == TexelFormat::Rgba8Unorm || format == TexelFormat::Rgba8Srgb;
}

// Writes a file's texels.
void take_texels(const pictures::DecodedPicture& picture, const exec::FormatInfo& info, uint32_t threads,
                 Texel* to) {
  const ByteValues values(info);
  const auto take = [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i)
      for (size_t c = 0; c < 4; ++c)
        to[i][c] = !picture.floats.empty() ? double(picture.floats[i * 4 + c])
                   : c < 3                 ? values.color[picture.bytes[i * 4 + c]]
                                           : values.alpha[picture.bytes[i * 4 + c]];
  };
  parallel_ranges(size_t{picture.width} * picture.height, kTexelsOfRange, threads, take);
}

Texel made_up(const ImageDescription& image, uint32_t x, uint32_t y, uint32_t z, RandomNumbers& random) {
  if (image.init == "value") return image.value;
  if (image.init == "random") return {random.next_unit(), random.next_unit(), random.next_unit(), 1};
  if (image.init == "checker") {
    const double v = (x / 8 + y / 8 + z / 8) % 2 ? 0.25 : 1;
    return {v, v, v, 1};
  }
  return {0, 0, 0, 0};
}

// Returns the texel with number `index` in its image. Channels that the format lacks are 0, and alpha is 1.
Texel given(const ImageDescription& image, size_t index, size_t channels) {
  Texel out{0, 0, 0, 1};
  std::copy_n(image.data.begin() + std::ptrdiff_t(index * channels), channels, out.begin());
  return out;
}

void check_data(const ImageDescription& image, const exec::ImageView& view, size_t channels) {
  const size_t wanted = size_t{view.width} * view.height * view.depth * view.layers * channels;
  if (image.data.size() != wanted)
    throw UserError(
        image.where,
        fmt::format(
            "image '{}' has {} numbers, but {} x {} x {} texels with {} layers and {} channels want {}",
            image.name, image.data.size(), view.width, view.height, view.depth, view.layers, channels,
            wanted));
}

// Returns the texels of level 0 of an image whose size is known and that has no files.
std::vector<Texel> texels_without_files(const ImageDescription& image, const exec::ImageView& view,
                                        size_t channels) {
  std::vector<Texel> out;
  RandomNumbers random(image.seed);
  const bool is_given = image.init == "data";
  if (is_given) check_data(image, view, channels);
  for (uint32_t layer = 0; layer < view.layers; ++layer)
    for (uint32_t z = 0; z < view.depth; ++z)
      for (uint32_t y = 0; y < view.height; ++y)
        for (uint32_t x = 0; x < view.width; ++x)
          out.push_back(is_given ? given(image, out.size(), channels) : made_up(image, x, y, z, random));
  return out;
}

exec::Words words_of(const Texel& texel, const exec::FormatInfo& info) {
  exec::Words out{};
  for (size_t c = 0; c < 4; ++c)
    out[c] = exec::is_integer(info) ? uint32_t(int64_t(texel[c])) : std::bit_cast<uint32_t>(float(texel[c]));
  return out;
}

// Returns the means of the texels above, two in each direction that halves.
std::vector<Texel> halved(const std::vector<Texel>& above, const exec::ImageView& view, uint32_t level,
                          uint32_t threads) {
  const uint32_t w = view.extent(0, level), h = view.extent(1, level), d = view.extent(2, level);
  const uint32_t aw = view.extent(0, level - 1), ah = view.extent(1, level - 1),
                 ad = view.extent(2, level - 1);
  const size_t rows = size_t{view.layers} * d * h;
  std::vector<Texel> out(rows * w);
  const auto fill = [&](size_t row) {
    const size_t y = row % h, z = row / h % d, layer = row / h / d;
    for (uint32_t x = 0; x < w; ++x) {
      Texel sum{};
      for (uint32_t corner = 0; corner < 8; ++corner) {
        const size_t sx = std::min(2 * x + (corner & 1), aw - 1),
                     sy = std::min<size_t>(2 * y + (corner >> 1 & 1), ah - 1),
                     sz = std::min<size_t>(2 * z + (corner >> 2), ad - 1);
        for (size_t c = 0; c < 4; ++c) sum[c] += above[((layer * ad + sz) * ah + sy) * aw + sx][c] / 8;
      }
      out[row * w + x] = sum;
    }
  };
  parallel_ranges(rows, 1 + kTexelsOfRange / w, threads, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) fill(row);
  });
  return out;
}

void check_format(const ImageDescription& image, const exec::FormatInfo& info, const std::string& texel) {
  const std::string found = info.numeric == exec::Numeric::Uint   ? "u32"
                            : info.numeric == exec::Numeric::Sint ? "s32"
                                                                  : "f32";
  if (!texel.empty() && found != texel)
    throw UserError(image.where,
                    fmt::format("image '{}' has the format {}, whose texels are {}, and the shader's are {}",
                                image.name, info.name, found, texel));
}

void check_shape(const ImageDescription& image, const exec::ImageView& view) {
  const bool is_flat = view.depth == 1, is_line = view.height == 1 && is_flat;
  const char* wrong = nullptr;
  if (view.samples > 1 && (isa::num_coordinates(view.shape) != 2 || image.mipmaps))
    wrong = "has several samples, so it must be 2D and without mipmaps";
  if (view.shape != ImageShape::D3 && !is_flat) wrong = "is not 3D, so its depth must be 1";
  if ((view.shape == ImageShape::D1 || view.shape == ImageShape::A1d || view.shape == ImageShape::Buffer) &&
      !is_line)
    wrong = "is 1D, so its height must be 1";
  if (isa::is_cube(view.shape) && (view.width != view.height || view.layers % 6))
    wrong = "is a cube, so it must be as wide as high and have six layers";
  if (!isa::has_layers(view.shape) && !isa::is_cube(view.shape) && view.layers != view.samples)
    wrong = "is not an array, so it must have one layer";
  if (wrong)
    throw UserError(image.where,
                    fmt::format("image '{}' is {} x {} x {} with {} layers, and the shader's {}", image.name,
                                view.width, view.height, view.depth, view.layers, wrong));
}

// Returns the format of an image. The first file says which one an image has that names none.
TexelFormat format_of(const ImageDescription& image, const DeclaredImage& declared,
                      std::span<const pictures::DecodedPicture* const> files) {
  const TexelFormat widest = declared.texel == "u32"   ? TexelFormat::Rgba32Uint
                             : declared.texel == "s32" ? TexelFormat::Rgba32Sint
                                                       : TexelFormat::Rgba32Float;
  if (image.format) return *image.format;
  if (files.empty()) return format_named(declared.format).value_or(widest);
  return files[0]->floats.empty() && widest == TexelFormat::Rgba32Float ? TexelFormat::Rgba8Unorm : widest;
}

// Sets how large the image is: as its files are, or as it says.
void size_image(const ImageDescription& image, std::span<const pictures::DecodedPicture* const> files,
                std::array<uint32_t, 3> fallback, exec::ImageView& view) {
  if (files.empty()) {
    const std::array<uint32_t, 3> size = image.size[0] ? image.size : fallback;
    view.width = size[0];
    view.height = isa::num_coordinates(view.shape) > 1 || image.size[0] ? size[1] : 1;
    view.depth = view.shape == ImageShape::D3 || image.size[0] ? size[2] : 1;
    return;
  }
  view.width = files[0]->width, view.height = files[0]->height;
  if (image.size[0] && (image.size[0] != view.width || image.size[1] != view.height))
    throw UserError(image.where,
                    fmt::format("the file of image '{}' is {} x {}, and 'size' says {} x {}", image.name,
                                view.width, view.height, image.size[0], image.size[1]));
  if (files.size() != view.layers)
    throw UserError(image.where,
                    fmt::format("image '{}' names {} files and has {} layers of {} samples; each sample of a "
                                "layer takes a file",
                                image.name, files.size(), image.layers, image.samples));
}

// Returns how an image of integers is sampled. Texels of integers cannot be filtered.
exec::Sampler sampler_of_integers(const ImageDescription& image) {
  exec::Sampler out = image.sampler;
  if (!image.has_filter) out.mag = out.min = exec::Filter::Nearest;
  for (size_t c = 0; c < 4; ++c)
    out.border[c] = uint32_t(int64_t(std::fmax(-0x1p31, std::fmin(image.border[c], 0x1p32 - 1))));
  return out;
}

}  // namespace

PictureMaker::PictureMaker(std::span<const ImageDescription> images, uint32_t threads) : threads_(threads) {
  for (const ImageDescription& image : images)
    for (const std::string& file : image.files) files_.try_emplace(file);
  std::vector<std::pair<const std::string, pictures::DecodedPicture>*> all;
  for (auto& entry : files_) all.push_back(&entry);
  parallel_ranges(all.size(), 1, threads,
                  [&](size_t i, size_t) { all[i]->second = pictures::decode_picture_file(all[i]->first); });
}

const pictures::DecodedPicture& PictureMaker::file_of(const std::string& path,
                                                      const SourceLocation& where) const {
  const pictures::DecodedPicture& picture = files_.at(path);
  if (!picture.error.empty())
    throw UserError(where, fmt::format("cannot read the image '{}': {}", path, picture.error));
  return picture;
}

Picture PictureMaker::make(const ImageDescription& image, const DeclaredImage& declared,
                           std::array<uint32_t, 3> fallback) const {
  Picture out;
  exec::ImageView& view = out.view;
  std::vector<const pictures::DecodedPicture*> files;
  for (const std::string& file : image.files) {
    files.push_back(&file_of(file, image.where));
    if (files.back()->width != files[0]->width || files.back()->height != files[0]->height)
      throw UserError(image.where, fmt::format("'{}' is {} x {}, and the files before it are {} x {}", file,
                                               files.back()->width, files.back()->height, files[0]->width,
                                               files[0]->height));
  }
  view.format = format_of(image, declared, files);
  const exec::FormatInfo& info = exec::info_of(view.format);
  check_format(image, info, declared.texel);
  view.name = image.name, view.shape = declared.shape;
  view.sampler = exec::is_integer(info) ? sampler_of_integers(image) : image.sampler;
  view.layers = image.layers * image.samples, view.samples = image.samples;
  if (isa::is_cube(view.shape) && files.empty() && image.layers == 1) view.layers = 6;
  size_image(image, files, fallback, view);
  check_shape(image, view);
  if (image.mipmaps) view.levels = uint32_t(std::bit_width(std::max({view.width, view.height, view.depth})));

  out.texels.resize(view.bytes());
  std::byte* to = out.texels.data();
  const size_t of_file = size_t{view.width} * view.height;
  const auto has_bytes = [](const pictures::DecodedPicture* file) { return file->floats.empty(); };
  const bool copies =
      !files.empty() && keeps_bytes(view.format) && std::all_of(files.begin(), files.end(), has_bytes);
  if (copies)
    for (size_t i = 0; i < files.size(); ++i)
      std::memcpy(to + i * of_file * 4, files[i]->bytes.data(), of_file * 4);
  if (copies && view.levels == 1) return out;
  std::vector<Texel> level;
  if (files.empty())
    level = texels_without_files(image, view, info.channels);
  else
    level.resize(files.size() * of_file);
  for (size_t i = 0; i < files.size(); ++i) take_texels(*files[i], info, threads_, &level[i * of_file]);
  for (uint32_t l = 0; l < view.levels; ++l) {
    if (l) level = halved(level, view, l, threads_);
    if (l || !copies)
      parallel_ranges(level.size(), kTexelsOfRange, threads_, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
          exec::encode(view.format, words_of(level[i], info), to + i * info.bytes);
      });
    to += level.size() * info.bytes;
  }
  return out;
}

std::vector<uint32_t> texels_as_words(const exec::ImageView& view, const std::byte* data) {
  const exec::FormatInfo& info = exec::info_of(view.format);
  std::vector<uint32_t> out;
  const size_t slices = size_t{view.depth} * view.layers, row_bytes = size_t{view.blocks(0, 0)} * info.bytes;
  out.reserve(4 * view.width * view.height * slices);
  for (size_t slice = 0; slice < slices; ++slice)
    for (uint32_t y = 0; y < view.height; ++y) {
      const std::byte* const row = data + (slice * view.blocks(1, 0) + y / info.block) * row_bytes;
      for (uint32_t x = 0; x < view.width; ++x)
        for (uint32_t word : exec::decode_at(view.format, row + x / info.block * info.bytes, x, y))
          out.push_back(word);
    }
  return out;
}

std::vector<float> texels_as_floats(const exec::ImageView& view, const std::byte* data) {
  const exec::Numeric numeric = exec::info_of(view.format).numeric;
  std::vector<float> out;
  for (uint32_t word : texels_as_words(view, data))
    out.push_back(numeric == exec::Numeric::Uint   ? float(word)
                  : numeric == exec::Numeric::Sint ? float(int32_t(word))
                                                   : std::bit_cast<float>(word));
  return out;
}

}  // namespace glint::pipeline
