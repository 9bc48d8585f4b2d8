// Filters textures in double precision, texel by texel, after the text of Vulkan's "Image Operations".
// SPDX-License-Identifier: Apache-2.0
#include "tests/ops/sampling.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "tests/ops/numbers.h"

namespace glint::test {
namespace {

using exec::Comparison;
using exec::Filter;
using exec::Wrap;

constexpr int64_t kOutside = std::numeric_limits<int64_t>::min();

int64_t wrapped(Wrap mode, int64_t i, int64_t size) {
  const auto period = [&](int64_t n) { return (i % n + n) % n; };
  switch (mode) {
    case Wrap::Repeat:
      return period(size);
    case Wrap::MirroredRepeat:
      return period(2 * size) < size ? period(2 * size) : 2 * size - 1 - period(2 * size);
    case Wrap::ClampToEdge:
      return std::clamp<int64_t>(i, 0, size - 1);
    case Wrap::ClampToBorder:
      return i >= 0 && i < size ? i : kOutside;
    case Wrap::MirrorClampToEdge:
      return std::min(i < 0 ? -1 - i : i, size - 1);
  }
  return kOutside;
}

bool holds(Comparison comparison, double reference, double texel) {
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

using Vector = std::array<double, 3>;

// Holds the axes of the faces +x -x +y -y +z -z: the directions in which s and t grow, and the face's own.
struct Axes {
  Vector s, t, r;
};
constexpr Axes kFaces[] = {{{0, 0, -1}, {0, -1, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, -1, 0}, {-1, 0, 0}},
                           {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},   {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                           {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}},  {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
double product(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
// Returns the face whose own direction is nearest. Of equals, z goes before y and y before x.
int64_t face_of(const Vector& direction) {
  int64_t best = 5;
  for (int64_t face = 5; face >= 0; --face)
    if (product(kFaces[face].r, direction) > product(kFaces[best].r, direction)) best = face;
  return best;
}
// Returns s and t from -1 to 1 on the face.
Vector on_face(int64_t face, const Vector& direction) {
  const Axes& axes = kFaces[face];
  const double r = product(axes.r, direction);
  return {product(axes.s, direction) / r, product(axes.t, direction) / r, 0};
}

}  // namespace

int64_t Sampling::decided(double x, bool is_exact) {
  if (!is_exact && std::fabs(x - std::round(x)) < 1e-4) is_sharp_ = false;
  return int64_t(std::floor(x));
}

// Coordinates have few bits, which a product with a power of two keeps exact.
bool Sampling::is_exact_on(int64_t size) const {
  return !is_moved_ && !geometry_.is_cube && (sampler_.unnormalized || std::has_single_bit(uint64_t(size)));
}

Sampling::Place Sampling::place_of(const Request& request) {
  Place out;
  out.at = request.at;
  const int64_t layers = geometry_.is_cube ? image_.view.layers / 6 : image_.view.layers;
  if (geometry_.has_layers) out.layer = std::clamp<int64_t>(request.layer, 0, layers - 1);
  if (!geometry_.is_cube) return out;
  const int64_t face = face_of(request.at);
  const Vector place = on_face(face, request.at);
  for (size_t i = 0; i < 2; ++i) {
    if (std::fabs(place[i]) > 0.999) is_sharp_ = false;  // on the edge of a face
    out.at[i] = (place[i] + 1) / 2;
  }
  out.layer = out.layer * 6 + face;
  return out;
}

// Returns the level of detail before limits, and the samples: log2 of a footprint's longer side in texels,
// divided by the number of samples that it holds beside each other.
Sampling::Footprint Sampling::footprint_of(const Request& request) {
  if (!request.has_gradients) return {request.level, 1, {}};
  double lengths[2];
  const Vector* const changes[] = {&request.dx, &request.dy};
  for (size_t k = 0; k < 2; ++k) {
    const Vector& change = *changes[k];
    Vector d = change;
    if (geometry_.is_cube) {
      const Axes& axes = kFaces[face_of(request.at)];
      const double r = product(axes.r, request.at), dr = product(axes.r, change);
      // This is the derivative of (s / r + 1) / 2.
      d = {(product(axes.s, change) * r - product(axes.s, request.at) * dr) / (2 * r * r),
           (product(axes.t, change) * r - product(axes.t, request.at) * dr) / (2 * r * r), 0};
    }
    double sum = 0;
    for (int axis = 0; axis < geometry_.axes; ++axis)
      sum += std::pow(double(image_.extent(axis, 0)) * d[size_t(axis)], 2);
    lengths[k] = std::sqrt(sum);
  }
  const double longer = std::max(lengths[0], lengths[1]), shorter = std::min(lengths[0], lengths[1]);
  if (longer == 0) return {-std::numeric_limits<double>::infinity(), 1, {}};
  Footprint out{std::log2(longer), 1, *changes[lengths[1] > lengths[0]]};
  const double most = double(sampler_.max_anisotropy);
  if (most == 1 || geometry_.axes != 2 || sampler_.unnormalized || image_.format.is_integer()) return out;
  const double ratio = std::min({shorter == 0 ? most : longer / shorter, most, std::max(longer, 1.0)});
  const bool is_same = lengths[0] == lengths[1] && !geometry_.is_cube;
  if (ratio != most && !is_same && std::fabs(ratio - std::round(ratio)) < 1e-4) is_sharp_ = false;
  out.lod = std::log2(longer / ratio), out.samples = int64_t(std::ceil(ratio));
  return out;
}

Colour Sampling::compared(const Request& request, const Colour& colour) const {
  if (!request.compares) return colour;
  const double reference =
      image_.format.is_normalized() ? std::clamp(request.reference, 0.0, 1.0) : request.reference;
  // Texels are compared in single precision.
  const double texel = value_of(kSingle, bits_of(kSingle, colour[0]));
  return {holds(sampler_.compare, reference, texel) ? 1.0 : 0.0, 0, 0, 0};
}

// Finds the lowest texel of the filter on each axis, and the weight of the one behind it.
Sampling::Index Sampling::first_of(const Request& request, const Place& place, int64_t level, bool linear,
                                   std::array<double, 3>& weight) {
  Index out{};
  for (size_t axis = 0; axis < size_t(geometry_.axes); ++axis) {
    const int64_t size = image_.extent(int(axis), level);
    const double x =
        (sampler_.unnormalized ? place.at[axis] : place.at[axis] * double(size)) - (linear ? 0.5 : 0.0);
    // A linear filter of colours is continuous.
    const bool is_exact = is_exact_on(size), is_continuous = linear && !request.compares && has_mean();
    const int64_t first = decided(x, is_exact || is_continuous);
    weight[axis] = x - double(first);
    out[axis] = first + request.offset[axis];
  }
  return out;
}

Colour Sampling::texel(const Request& request, const Place& place, int64_t level, Index index) {
  TexelAt at{{}, place.layer, level};
  const int64_t size = image_.extent(0, level);
  if (geometry_.is_cube) {
    const bool is_inside = index[0] >= 0 && index[0] < size && index[1] >= 0 && index[1] < size;
    at.at = {index[0], index[1], 0};
    if (!is_inside) {
      // A texel past an edge is the neighbour's that touches the edge there. Its middle lies half a texel
      // below this face's plane.
      Vector middle{};
      double depth = 1;
      for (size_t i = 0; i < 2; ++i) {
        middle[i] = index[i] < 0 ? -1 : index[i] >= size ? 1 : (2 * double(index[i]) + 1) / double(size) - 1;
        if (index[i] < 0 || index[i] >= size) depth = 1 - 1 / double(size);
      }
      const Axes& axes = kFaces[place.layer % 6];
      Vector direction{};
      for (size_t i = 0; i < 3; ++i)
        direction[i] = axes.s[i] * middle[0] + axes.t[i] * middle[1] + axes.r[i] * depth;
      const int64_t face = face_of(direction);
      const Vector there = on_face(face, direction);
      for (size_t i = 0; i < 2; ++i)
        at.at[i] = std::clamp(int64_t(std::floor((there[i] + 1) / 2 * double(size))), int64_t{0}, size - 1);
      at.layer = place.layer / 6 * 6 + face;
    }
    return compared(request, image_.read(bytes_, at));
  }
  for (size_t axis = 0; axis < size_t(geometry_.axes); ++axis) {
    at.at[axis] = wrapped(sampler_.wrap[axis], index[axis], image_.extent(int(axis), level));
    if (at.at[axis] == kOutside) {
      const Words border{sampler_.border[0], sampler_.border[1], sampler_.border[2], sampler_.border[3]};
      return compared(request, kept(image_.format, colour_of(image_.format, border)));
    }
  }
  return compared(request, image_.read(bytes_, at));
}

// Returns the texel of a block of 2 x 2, which is missing where three faces of a cube meet: the average of
// the other three stands for it.
Colour Sampling::corner(const Request& request, const Place& place, int64_t level, Index index) {
  const int64_t size = image_.extent(0, level);
  const auto is_out = [&](int64_t i) { return i < 0 || i >= size; };
  if (!geometry_.is_cube || !is_out(index[0]) || !is_out(index[1]))
    return texel(request, place, level, index);
  if (image_.format.is_integer()) is_sharp_ = false;  // Nobody says what the average of integers is.
  const Index in{std::clamp<int64_t>(index[0], 0, size - 1), std::clamp<int64_t>(index[1], 0, size - 1), 0};
  const Colour a = texel(request, place, level, in), b = texel(request, place, level, {in[0], index[1], 0}),
               c = texel(request, place, level, {index[0], in[1], 0});
  Colour out{};
  for (size_t i = 0; i < 4; ++i) out[i] = (a[i] + b[i] + c[i]) / 3;
  return out;
}

Colour Sampling::filtered(const Request& request, const Place& place, int64_t level, bool linear) {
  std::array<double, 3> weight{};
  const Index first = first_of(request, place, level, linear, weight);
  if (!linear) return texel(request, place, level, first);
  std::vector<std::pair<Colour, double>> texels;
  for (size_t block = 0; block < size_t{1} << geometry_.axes; ++block) {
    Index index = first;
    double share = 1;
    for (size_t axis = 0; axis < size_t(geometry_.axes); ++axis) {
      const bool is_second = block >> axis & 1;
      index[axis] += is_second;
      share *= is_second ? weight[axis] : 1 - weight[axis];
    }
    texels.emplace_back(corner(request, place, level, index), share);
  }
  return reduced(texels);
}

// Reduces texels with shares, or other colours, to one: their sum by share, or the extreme of those with any.
Colour Sampling::reduced(const std::vector<std::pair<Colour, double>>& colours) const {
  Colour out{};
  bool is_first = true;
  for (const auto& [colour, share] : colours) {
    if (share == 0) continue;
    for (size_t i = 0; i < 4; ++i)
      out[i] = has_mean()                                     ? out[i] + share * colour[i]
               : is_first                                     ? colour[i]
               : sampler_.reduction == exec::Reduction::Least ? std::min(out[i], colour[i])
                                                              : std::max(out[i], colour[i]);
    is_first = false;
  }
  return out;
}

Colour Sampling::on_levels(const Request& request, double lod, bool linear) {
  const Place place = place_of(request);
  if (sampler_.unnormalized) return filtered(request, place, 0, linear);
  if (sampler_.mip == Filter::Nearest)  // Of two equally near levels, it is the finer one.
    return filtered(request, place, std::max<int64_t>(int64_t(std::ceil(lod - 0.5)), 0), linear);
  const auto low = int64_t(lod), high = std::min<int64_t>(low + 1, image_.view.levels - 1);
  const Colour out = filtered(request, place, low, linear);
  const double share = lod - double(low);
  if (share == 0) return out;
  return reduced({{out, 1 - share}, {filtered(request, place, high, linear), share}});
}

Colour Sampling::sample(const Request& request) {
  const Footprint footprint = footprint_of(request);
  const double limited =
      std::min(std::max(footprint.lod + double(sampler_.lod_bias), double(sampler_.min_lod)),
               double(sampler_.max_lod));
  // Without gradients the level is exact. With gradients it may fall on either side of a decision.
  if (request.has_gradients && std::fabs(2 * limited - std::round(2 * limited)) < 1e-4 &&
      limited != double(sampler_.min_lod) && limited != double(sampler_.max_lod))
    is_sharp_ = false;
  const bool linear = (limited > 0 ? sampler_.min : sampler_.mag) == Filter::Linear;
  const double lod = std::clamp(limited, 0.0, double(image_.view.levels - 1));
  if (footprint.samples == 1) return on_levels(request, lod, linear);
  is_moved_ = true;
  std::vector<std::pair<Colour, double>> samples;
  for (int64_t i = 1; i <= footprint.samples; ++i) {
    Request moved = request;
    const double along = double(2 * i - footprint.samples - 1) / double(2 * (footprint.samples + 1));
    for (size_t axis = 0; axis < 3; ++axis) moved.at[axis] += along * footprint.side[axis];
    samples.emplace_back(on_levels(moved, lod, linear), 1 / double(footprint.samples));
  }
  return reduced(samples);
}

Colour Sampling::gather(const Request& request, size_t component) {
  const Place place = place_of(request);
  std::array<double, 3> weight{};
  const Index first = first_of(request, place, 0, true, weight);
  for (size_t axis = 0; axis < 2; ++axis)
    if (std::min(weight[axis], 1 - weight[axis]) < 1e-4 && !is_exact_on(image_.extent(int(axis), 0)))
      is_sharp_ = false;
  const auto at = [&](int64_t x, int64_t y) {
    return corner(request, place, 0, {first[0] + x, first[1] + y, 0})[request.compares ? 0 : component];
  };
  return {at(0, 1), at(1, 1), at(1, 0), at(0, 0)};
}

}  // namespace glint::test
