// Samples after the Vulkan specification's chapter "Image Operations".
// SPDX-License-Identifier: Apache-2.0
#include "exec/texture_filter.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

#include "exec/texture_address.h"

namespace glint::exec {
namespace {

Words extremes(const Words& a, const Words& b, Reduction reduction) {
  Words out;
  for (size_t c = 0; c < 4; ++c) {
    const bool takes_first = reduction == Reduction::Least ? !(float_of(b[c]) < float_of(a[c]))
                                                           : !(float_of(b[c]) > float_of(a[c]));
    out[c] = takes_first ? a[c] : b[c];
  }
  return out;
}

Words mixed(const Words& a, const Words& b, float weight) {
  if (weight == 0.0f) return a;
  Words out;
  for (size_t c = 0; c < 4; ++c)
    out[c] = std::bit_cast<uint32_t>(float_of(a[c]) * (1.0f - weight) + float_of(b[c]) * weight);
  return out;
}

// Returns what a filter makes of two texels, of which the second has a weight.
Words reduced(const Words& a, const Words& b, float weight, Reduction reduction) {
  if (reduction == Reduction::Mean) [[likely]]
    return mixed(a, b, weight);
  return weight == 0.0f ? a : extremes(a, b, reduction);
}

bool holds(Comparison comparison, float reference, float texel) {
  switch (comparison) {
    case Comparison::Never:
      return false;
    case Comparison::Less:
      return reference < texel;
    case Comparison::Equal:
      return reference == texel;
    case Comparison::LessOrEqual:
      return reference <= texel;
    case Comparison::Greater:
      return reference > texel;
    case Comparison::NotEqual:
      return reference != texel;
    case Comparison::GreaterOrEqual:
      return reference >= texel;
    case Comparison::Always:
      return true;
  }
  return false;
}

}  // namespace

TexelReader::Levels TexelReader::levels_of(float lod) const {
  if (image_.levels == 1 || sampler_.unnormalized) return {};
  const auto last = float(image_.levels - 1);
  const float d = lod > 0.0f ? std::min(lod, last) : 0.0f;
  // By Vulkan's "Image Level(s) Selection", the nearest level is taken. Exactly between two levels, the finer
  // one is taken.
  if (sampler_.mip == Filter::Nearest) {
    const auto level = uint32_t(std::max(std::ceil(d + 0.5f) - 1.0f, 0.0f));
    return {level, level, 0.0f};
  }
  const float first = std::floor(d);
  return {uint32_t(first), uint32_t(std::min(first + 1.0f, last)), d - first};
}

TexelReader::Place TexelReader::place_of(const SampleRequest& request) const {
  Place place{request.at, 0, isa::num_coordinates(request.shape), isa::is_cube(request.shape)};
  const int64_t layers = place.is_cube ? image_.layers / 6 : image_.layers;
  const auto layer = isa::has_layers(request.shape) ? std::clamp<int64_t>(request.layer, 0, layers - 1) : 0;
  place.layer = uint32_t(layer);
  if (place.is_cube) {
    const CubePoint point = cube_point(request.at);
    place.at = {point.s, point.t, 0.0f};
    place.layer = place.layer * 6 + point.face;
    place.axes = 2;
  }
  return place;
}

TexelReader::Axis TexelReader::axis_of(const SampleRequest& request, const Place& place, int axis,
                                       uint32_t level, bool linear) const {
  const uint32_t size = image_.extent(axis, level);
  const auto n = size_t(axis);
  const Wrap mode = place.is_cube ? Wrap::ClampToEdge : sampler_.wrap[n];
  float x = sampler_.unnormalized ? place.at[n] : place.at[n] * float(size);
  if (linear) x -= 0.5f;
  double middle = tame(mode, x, size);
  if (linear && sampler_.weight_bits) {
    const double steps = double(uint64_t{1} << sampler_.weight_bits);
    middle = std::floor(middle * steps + 0.5) / steps;
  }
  const double first = std::floor(middle);
  const int64_t i = int64_t(first) + request.offset[n];
  if (!linear) return {wrap(mode, i, size), 0, 0.0f};
  // On cubes the neighbour's texels stand for those outside. They are found when they are read.
  if (place.is_cube) {
    const int64_t edge = std::clamp<int64_t>(i, -1, size - 1);
    return {edge, edge + 1, float(middle - first)};
  }
  const Axis out{wrap(mode, i, size), wrap(mode, i + 1, size), float(middle - first)};
  return out.first == out.second ? Axis{out.first, out.second, 0.0f} : out;
}

Words TexelReader::compared(const SampleRequest& request, Words texel) const {
  if (!request.compare) return texel;
  const float reference = is_normalized(info_of(image_.format))
                              ? std::min(std::max(request.reference, 0.0f), 1.0f)
                              : request.reference;
  return {std::bit_cast<uint32_t>(holds(sampler_.compare, reference, float_of(texel[0])) ? 1.0f : 0.0f), 0, 0,
          0};
}

Words TexelReader::stored(const TexelIndex& at) {
  const Address address = image_.address_of(at);
  const std::byte* from = memory_.find(address, image_.texel_bytes());
  if (!from) {
    error_ = "is smaller in memory than its size says";
    return {};
  }
  texels_[num_texels_++] = address;
  // Most texels stand alone, and their decoder is compiled into this function.
  return image_.format < kFirstBlockFormat ? decode(image_.format, from)
                                           : decode_at(image_.format, from, at.x, at.y);
}

Words TexelReader::read(const SampleRequest& request, const Place& place, uint32_t level,
                        std::array<int64_t, 3> at) {
  uint32_t layer = place.layer;
  const int64_t size = image_.extent(0, level);
  if (place.is_cube && (at[0] < 0 || at[1] < 0 || at[0] >= size || at[1] >= size)) {
    const CubeTexel texel = across_edge(layer % 6, at[0], at[1], size);
    layer = layer / 6 * 6 + texel.face;
    at = {texel.x, texel.y, 0};
  }
  if (at[0] == kBorder || at[1] == kBorder || at[2] == kBorder)
    return compared(request, keep_channels(image_.format, sampler_.border));
  return compared(request, stored({uint32_t(at[0]), uint32_t(at[1]), uint32_t(at[2]), layer, level}));
}

void TexelReader::read_block(const SampleRequest& request, const Place& place, uint32_t level,
                             const std::array<Axis, 3>& axes, std::array<Words, 8>& out) {
  const int64_t size = image_.extent(0, level);
  const auto is_outside = [&](int64_t i) { return i < 0 || i >= size; };
  size_t corner = 8;
  for (size_t k = 0; k < size_t{1} << place.axes; ++k) {
    std::array<int64_t, 3> at{};
    for (size_t axis = 0; axis < size_t(place.axes); ++axis)
      at[axis] = k >> axis & 1 ? axes[axis].second : axes[axis].first;
    if (place.is_cube && is_outside(at[0]) && is_outside(at[1]))
      corner = k;
    else
      out[k] = read(request, place, level, at);
  }
  if (corner == 8) return;
  // Where three faces meet there is no fourth texel. Its value is the average of the three (Vulkan, "Cube Map
  // Edge Handling") or, for integers, a neighbour.
  if (is_integer(info_of(image_.format))) {
    out[corner] = out[corner ^ 1];
    return;
  }
  for (size_t c = 0; c < 4; ++c) {
    float sum = 0.0f;
    for (size_t k = 0; k < 4; ++k)
      if (k != corner) sum += float_of(out[k][c]);
    out[corner][c] = std::bit_cast<uint32_t>(sum / 3.0f);
  }
}

Words TexelReader::filter(const SampleRequest& request, const Place& place, uint32_t level, Filter filter) {
  const bool linear = filter == Filter::Linear;
  std::array<Axis, 3> axes{};
  for (int axis = 0; axis < place.axes; ++axis)
    axes[size_t(axis)] = axis_of(request, place, axis, level, linear);
  if (!linear) return read(request, place, level, {axes[0].first, axes[1].first, axes[2].first});
  std::array<Words, 8> texel;
  read_block(request, place, level, axes, texel);
  size_t count = size_t{1} << place.axes;
  for (const Axis& axis : axes) {
    count /= 2;
    for (size_t k = 0; k < count; ++k)
      texel[k] = reduced(texel[2 * k], texel[2 * k + 1], axis.weight, sampler_.reduction);
  }
  return texel[0];
}

// Choice: images with one or three axes are sampled isotropically, because Vulkan describes the anisotropic
// filter for two axes only. So are those with unnormalised coordinates, whose samplers have no anisotropy.
Footprint TexelReader::footprint_of(const SampleRequest& request) const {
  if (!request.has_gradients) return {request.lod, 1, false};
  const bool is_cube = isa::is_cube(request.shape);
  const int axes = is_cube ? 2 : isa::num_coordinates(request.shape);
  const bool is_flat = axes == 2 && !sampler_.unnormalized && !is_integer(info_of(image_.format));
  const float most = is_flat ? sampler_.max_anisotropy : 1.0f;
  if (!is_cube) return exec::footprint_of(image_, axes, request.dx, request.dy, most);
  return exec::footprint_of(image_, axes, cube_gradient(request.at, request.dx),
                            cube_gradient(request.at, request.dy), most);
}

Words TexelReader::filter_levels(const SampleRequest& request, const Levels& levels, Filter kind) {
  const Place place = place_of(request);
  const Words first = filter(request, place, levels.first, kind);
  return levels.weight == 0.0f
             ? first
             : reduced(first, filter(request, place, levels.second, kind), levels.weight, sampler_.reduction);
}

// Returns the mean of samples along the longer side of a footprint (Vulkan, "Texel Anisotropic Filtering"),
// or what else the sampler reduces them to. Choice: the sampler's filters hold for each sample. On a cube the
// direction moves, and not the place on its face, so that samples past an edge lie on the neighbour.
Words TexelReader::filter_along(const SampleRequest& request, const Footprint& footprint,
                                const Levels& levels, Filter kind) {
  const Gradient& side = footprint.is_along_y ? request.dy : request.dx;
  const bool has_mean = sampler_.reduction == Reduction::Mean;
  std::array<double, 4> sum{};
  Words out{};
  for (uint32_t i = 1; i <= footprint.samples; ++i) {
    const float share = float(i) / float(footprint.samples + 1) - 0.5f;
    SampleRequest one = request;
    for (size_t axis = 0; axis < 3; ++axis) one.at[axis] += share * side[axis];
    const Words words = filter_levels(one, levels, kind);
    if (!has_mean) out = i == 1 ? words : extremes(out, words, sampler_.reduction);
    for (size_t c = 0; c < 4; ++c) sum[c] += double(float_of(words[c]));
  }
  if (has_mean)
    for (size_t c = 0; c < 4; ++c) out[c] = std::bit_cast<uint32_t>(float(sum[c] / footprint.samples));
  return out;
}

Words TexelReader::sample(const SampleRequest& request) {
  const Footprint footprint = footprint_of(request);
  const float biased = footprint.lod + sampler_.lod_bias;
  // By Vulkan's "LOD", a value that is not a number counts as the smallest value.
  const float lod = std::min(biased > sampler_.min_lod ? biased : sampler_.min_lod, sampler_.max_lod);
  const Filter kind = lod > 0.0f ? sampler_.min : sampler_.mag;
  const Levels levels = levels_of(lod);
  if (is_integer(info_of(image_.format)) &&
      (kind == Filter::Linear || levels.weight != 0.0f || request.compare)) {
    error_ = "has integer texels, which can be neither filtered nor compared";
    return {};
  }
  // Filters work on each component alone, so the components may be chosen after them.
  return swizzled(image_, footprint.samples > 1 ? filter_along(request, footprint, levels, kind)
                                                : filter_levels(request, levels, kind));
}

Words TexelReader::gather(const SampleRequest& request, size_t component) {
  const Place place = place_of(request);
  std::array<Axis, 3> axes{};
  for (int axis = 0; axis < 2; ++axis) axes[size_t(axis)] = axis_of(request, place, axis, 0, true);
  std::array<Words, 8> texel{};
  read_block(request, place, 0, axes, texel);
  const size_t c = request.compare ? 0 : component;
  const auto shown = [&](size_t k) { return swizzled(image_, texel[k])[c]; };
  return {shown(2), shown(3), shown(1), shown(0)};
}

}  // namespace glint::exec
