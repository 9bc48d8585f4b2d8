// Reads picture files and encodes texels.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/description/pictures.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <optional>

#include "pictures/decode.h"
#include "pipeline/description/data.h"

namespace glint::pipeline {
namespace {

using exec::TexelFormat;
using isa::ImageShape;
using Texel = std::array<double, 4>;  // floats, or integers when the format has them

struct Layer {
  uint32_t width = 0, height = 0;
  bool is_float = false;
  std::vector<Texel> texels;
};

pictures::DecodedPicture load(const std::string& path, const SourceLocation& where) {
  pictures::DecodedPicture picture = pictures::decode_picture_file(path);
  if (!picture.error.empty())
    throw UserError(where, fmt::format("cannot read the image '{}': {}", path, picture.error));
  return picture;
}

// Returns a file's texels. Those of 8-bit files become values of 0 to 1, unless the format keeps integers.
Layer layer_of(const pictures::DecodedPicture& picture, bool as_integers) {
  Layer out;
  out.width = picture.width, out.height = picture.height;
  out.is_float = !picture.floats.empty();
  out.texels.resize(size_t(picture.width) * picture.height);
  const auto take = [&](const auto& data, double scale) {
    for (size_t i = 0; i < out.texels.size(); ++i)
      for (size_t c = 0; c < 4; ++c) out.texels[i][c] = double(data[i * 4 + c]) * scale;
  };
  if (out.is_float)
    take(picture.floats, 1.0);
  else
    take(picture.bytes, as_integers ? 1.0 : 1.0 / 255);
  return out;
}

// Converts encoded values of sRGB files to the linear ones that the format's encode() takes (IEC 61966-2-1).
double to_linear(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
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
std::vector<Texel> halved(const std::vector<Texel>& above, const exec::ImageView& view, uint32_t level) {
  const uint32_t w = view.extent(0, level), h = view.extent(1, level), d = view.extent(2, level);
  const uint32_t aw = view.extent(0, level - 1), ah = view.extent(1, level - 1),
                 ad = view.extent(2, level - 1);
  std::vector<Texel> out;
  for (uint32_t layer = 0; layer < view.layers; ++layer)
    for (uint32_t z = 0; z < d; ++z)
      for (uint32_t y = 0; y < h; ++y)
        for (uint32_t x = 0; x < w; ++x) {
          Texel sum{};
          for (uint32_t corner = 0; corner < 8; ++corner) {
            const uint32_t sx = std::min(2 * x + (corner & 1), aw - 1),
                           sy = std::min(2 * y + (corner >> 1 & 1), ah - 1),
                           sz = std::min(2 * z + (corner >> 2), ad - 1);
            for (size_t c = 0; c < 4; ++c)
              sum[c] += above[((size_t{layer} * ad + sz) * ah + sy) * aw + sx][c] / 8;
          }
          out.push_back(sum);
        }
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

// Returns how an image of integers is sampled. Texels of integers cannot be filtered.
exec::Sampler sampler_of_integers(const ImageDescription& image) {
  exec::Sampler out = image.sampler;
  if (!image.has_filter) out.mag = out.min = exec::Filter::Nearest;
  for (size_t c = 0; c < 4; ++c)
    out.border[c] = uint32_t(int64_t(std::fmax(-0x1p31, std::fmin(image.border[c], 0x1p32 - 1))));
  return out;
}

}  // namespace

Picture make_picture(const ImageDescription& image, ImageShape shape, const std::string& texel,
                     std::array<uint32_t, 3> fallback, const std::string& declared) {
  Picture out;
  exec::ImageView& view = out.view;
  const TexelFormat widest = texel == "u32"   ? TexelFormat::Rgba32Uint
                             : texel == "s32" ? TexelFormat::Rgba32Sint
                                              : TexelFormat::Rgba32Float;
  const TexelFormat plain = (image.files.empty() ? format_named(declared) : std::nullopt).value_or(widest);
  // The first file says which format an image has that names none.
  std::optional<pictures::DecodedPicture> first;
  if (!image.files.empty()) first = load(image.files[0], image.where);
  const bool has_floats = first && !first->floats.empty();
  view.format = image.format.value_or(!image.files.empty() && !has_floats && texel != "u32" && texel != "s32"
                                          ? TexelFormat::Rgba8Unorm
                                          : plain);
  const exec::FormatInfo& info = exec::info_of(view.format);
  check_format(image, info, texel);
  view.name = image.name, view.shape = shape;
  view.sampler = exec::is_integer(info) ? sampler_of_integers(image) : image.sampler;
  view.layers = image.layers * image.samples, view.samples = image.samples;
  if (isa::is_cube(shape) && image.files.empty() && image.layers == 1) view.layers = 6;

  std::vector<Texel> level;
  for (const std::string& file : image.files) {
    Layer layer = layer_of(first ? *first : load(file, image.where), exec::is_integer(info));
    first.reset();
    if (!level.empty() && (layer.width != view.width || layer.height != view.height))
      throw UserError(image.where, fmt::format("'{}' is {} x {}, and the files before it are {} x {}", file,
                                               layer.width, layer.height, view.width, view.height));
    view.width = layer.width, view.height = layer.height;
    if (info.numeric == exec::Numeric::Srgb && !layer.is_float)
      for (Texel& t : layer.texels)
        for (size_t c = 0; c < 3; ++c) t[c] = to_linear(t[c]);
    level.insert(level.end(), layer.texels.begin(), layer.texels.end());
  }
  if (image.files.empty()) {
    const std::array<uint32_t, 3> size = image.size[0] ? image.size : fallback;
    view.width = size[0];
    view.height = isa::num_coordinates(shape) > 1 || image.size[0] ? size[1] : 1;
    view.depth = shape == ImageShape::D3 || image.size[0] ? size[2] : 1;
    level = texels_without_files(image, view, info.channels);
  } else if (image.size[0] && (image.size[0] != view.width || image.size[1] != view.height)) {
    throw UserError(image.where,
                    fmt::format("the file of image '{}' is {} x {}, and 'size' says {} x {}", image.name,
                                view.width, view.height, image.size[0], image.size[1]));
  }
  check_shape(image, view);
  if (image.mipmaps) view.levels = uint32_t(std::bit_width(std::max({view.width, view.height, view.depth})));
  out.texels.resize(view.bytes());
  std::byte* to = out.texels.data();
  for (uint32_t l = 0; l < view.levels; ++l) {
    if (l) level = halved(level, view, l);
    for (const Texel& t : level) exec::encode(view.format, words_of(t, info), to), to += info.bytes;
  }
  return out;
}

std::vector<uint32_t> texels_as_words(const exec::ImageView& view, const std::byte* data) {
  const exec::FormatInfo& info = exec::info_of(view.format);
  std::vector<uint32_t> out;
  const size_t count = size_t{view.width} * view.height * view.depth * view.layers;
  out.reserve(4 * count);
  for (size_t i = 0; i < count; ++i)
    for (uint32_t word : exec::decode(view.format, data + i * info.bytes)) out.push_back(word);
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
