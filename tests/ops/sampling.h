// Filters textures in double precision, texel by texel, after the text of Vulkan's "Image Operations".
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "tests/ops/image_set.h"

namespace glint::test {

// Holds the operands of a sampling op as numbers.
struct Request {
  std::array<double, 3> at{};  // normalised coordinates, or a direction
  int64_t layer = 0;
  bool has_level = false, has_gradients = false;
  double level = 0;
  std::array<double, 3> dx{}, dy{};
  std::array<int64_t, 3> offset{};
  bool compares = false;
  double reference = 0;
};

// Samples one texture. Single precision may decide otherwise than doubles where a coordinate lies on the edge
// of a texel or a level, or where Vulkan leaves the texel open: is_sharp() is false then.
class Sampling {
 public:
  Sampling(const PlainImage& image, const exec::Sampler& sampler, const Geometry& geometry,
           const Bytes& bytes)
      : image_(image), sampler_(sampler), geometry_(geometry), bytes_(bytes) {}

  Colour sample(const Request& request);
  Colour gather(const Request& request, size_t component);
  bool is_sharp() const { return is_sharp_; }

 private:
  // Holds where the coordinates lie: on an axis from 0 to 1 (or in texels), on which layer or face.
  struct Place {
    std::array<double, 3> at{};
    int64_t layer = 0;
  };
  using Index = std::array<int64_t, 3>;
  Place place_of(const Request& request);
  // Holds how the footprint of gradients is sampled: so many samples along `side`, a change of the
  // coordinates.
  struct Footprint {
    double lod = 0;
    int64_t samples = 1;
    std::array<double, 3> side{};
  };
  Footprint footprint_of(const Request& request);
  Colour on_levels(const Request& request, double lod, bool linear);
  Colour filtered(const Request& request, const Place& place, int64_t level, bool linear);
  Colour texel(const Request& request, const Place& place, int64_t level, Index index);
  Colour corner(const Request& request, const Place& place, int64_t level, Index index);
  Colour compared(const Request& request, const Colour& colour) const;
  Index first_of(const Request& request, const Place& place, int64_t level, bool linear,
                 std::array<double, 3>& weight);
  Colour reduced(const std::vector<std::pair<Colour, double>>& colours) const;
  bool has_mean() const { return sampler_.reduction == exec::Reduction::Mean; }
  bool is_exact_on(int64_t size) const;
  // Returns the floor of a number that decides something.
  int64_t decided(double x, bool is_exact);

  const PlainImage& image_;
  const exec::Sampler& sampler_;
  const Geometry geometry_;
  const Bytes& bytes_;
  bool is_sharp_ = true;
  bool is_moved_ = false;  // The coordinates are those of one sample of several, and have all bits.
};

}  // namespace glint::test
