// Checks queries of textures and storage images against the parameters of the images.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/ops/image_set.h"
#include "tests/ops/oracle.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

// Returns OpenCL's number of the channels' type (cl.h), or 0.
uint32_t channel_type(const Format& format) {
  const int bits = format.channels.front().bits;
  const bool is_plain = std::all_of(format.channels.begin(), format.channels.end(),
                                    [&](const auto& channel) { return channel.bits == bits; });
  if (format.name == "rgb10a2_unorm") return 0x10e0;        // CL_UNORM_INT_101010_2
  if (format.name == "r5g6b5_unorm_pack16") return 0x10d4;  // CL_UNORM_SHORT_565
  if (!is_plain || bits < 8) return 0;
  const uint32_t width = bits == 8 ? 0 : bits == 16 ? 1 : 2;
  switch (format.kind) {
    case Kind::Snorm:
      return 0x10d0 + width;  // CL_SNORM_INT8, CL_SNORM_INT16
    case Kind::Unorm:
    case Kind::Srgb:
      return 0x10d2 + width;  // CL_UNORM_INT8, CL_UNORM_INT16
    case Kind::Sint:
      return 0x10d7 + width;  // CL_SIGNED_INT8 and on
    case Kind::Uint:
      return 0x10da + width;  // CL_UNSIGNED_INT8 and on
    case Kind::Float:
      return 0x10dc + width;  // CL_HALF_FLOAT, CL_FLOAT
  }
  return 0;
}

uint32_t channel_order(const Format& format) {
  std::string letters;
  for (const Format::Channel& channel : format.channels)
    if (channel.letter != 'e') letters += channel.letter;
  // A packed format has the order of its colours, wherever their bits lie.
  if (format.name.find("_pack") != std::string_view::npos)
    std::sort(letters.begin(), letters.end(), [](char a, char b) {
      return std::string_view("rgba").find(a) < std::string_view("rgba").find(b);
    });
  const bool is_srgb = format.kind == Kind::Srgb;
  if (letters == "r") return 0x10b0;
  if (letters == "rg") return 0x10b2;
  if (letters == "rgb") return 0x10b4;
  if (letters == "rgba") return is_srgb ? 0x10c1 : 0x10b5;
  if (letters == "bgra") return is_srgb ? 0x10c2 : 0x10b6;
  throw std::logic_error(fmt::format("the oracle does not know the order '{}'", letters));
}

uint32_t answer(std::string_view what, const PlainImage& image, int64_t level) {
  const exec::ImageView& view = image.view;
  if (what == "width") return uint32_t(image.extent(0, level));
  if (what == "height") return uint32_t(image.extent(1, level));
  if (what == "depth") return uint32_t(image.extent(2, level));
  if (what == "array_size") return view.layers / (isa::is_cube(view.shape) ? 6 : view.samples);
  if (what == "num_mipmap_levels") return view.levels;
  if (what == "num_samples") return view.samples;
  if (what == "normalized_coords") return view.sampler.unnormalized ? 0 : 1;
  if (what == "channel_data_type") return channel_type(image.format);
  if (what == "channel_order") return channel_order(image.format);
  throw std::logic_error(fmt::format("the oracle does not know the query '{}'", what));
}

uint64_t check_once(const isa::OpRow& row, std::string_view geometry, uint64_t enabled) {
  const auto parts = parts_of(row.name);
  const bool has_level = parts[1] == "level";
  OpLab lab(row);
  Random random{enabled};
  std::vector<PlainImage> images = add_images(lab, geometry_of({geometry}), Formats::All, 4, random);
  for (PlainImage& image : images) {
    if (geometry == "a2d" && image.handle % 3 == 0) image.view.samples = 3;
    image.view.sampler.unnormalized = image.handle % 2;
    lab.world.images[image.handle].samples = image.view.samples;
    lab.world.images[image.handle].sampler = image.view.sampler;
  }
  REQUIRE(lab.num_sources() == (has_level ? 2 : 1));
  REQUIRE(lab.num_results() == 1);
  std::vector<Column> sources(lab.num_sources()), results(1);
  for (size_t t = 0; t < kThreads; ++t) {
    const PlainImage& image = images[(t + enabled % 7) % images.size()];
    const uint32_t level = random.below(image.view.levels);
    sources[0][t] = image.handle;
    if (has_level) sources[1][t] = level;
    results[0][t] = enabled >> t & 1 ? answer(parts[has_level ? 2 : 1], image, has_level ? level : 0)
                                     : uint32_t(OpLab::kUntouched);
  }
  const Spaces before = lab.random_spaces(random);
  const Outcome outcome = lab.run(sources, enabled, before);
  CHECK(difference(outcome, results, before) == "");
  return outcome.lanes;
}

}  // namespace

uint64_t check_image_query(const isa::OpRow& row) {
  uint64_t lanes = 0;
  for (const std::string_view geometry : {"1d", "2d", "3d", "a1d", "a2d", "cube", "acube"})
    for (const uint64_t enabled : {~uint64_t{0}, uint64_t{0x8421'0f07'1357'9bdf}})
      lanes += check_once(row, geometry, enabled);
  return lanes;
}

}  // namespace glint::test
