// Does the texture unit's work on one lane: reads an image's texels, filters them, and notes where they lay.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "exec/image_view.h"
#include "exec/texel_list.h"
#include "exec/texture_address.h"
#include "memsys/address_space.h"

namespace glint::exec {

struct SampleRequest {
  isa::ImageShape shape = isa::ImageShape::D2;
  std::array<float, 3> at{};   // normalised coordinates, or the direction from the middle of a cube
  int32_t layer = 0;           // clamped to the existing layers
  float lod = 0.0f;            // level of detail before the sampler's bias and limits
  bool has_gradients = false;  // The level follows from the gradients of `at`.
  Gradient dx{}, dy{};
  std::array<int32_t, 3> offset{};  // texels
  bool compare = false;
  float reference = 0.0f;
};

// Serves one request to one image. After a mistake of the program, error() says what it is, and the result
// means nothing.
class TexelReader {
 public:
  TexelReader(const ImageView& image, const Sampler& sampler, const mem::AddressSpace& memory)
      : image_(image), sampler_(sampler), memory_(memory) {}

  // Returns filtered texels. Choice: of texels that are integers, the middle sample of an anisotropic filter
  // is taken, because they have no mean. Model: weights are floats; hardware has 8 bits of fraction.
  Words sample(const SampleRequest& request);
  // Returns component `component` of the four texels of a linear filter at level 0: (0,1), (1,1), (1,0),
  // (0,0).
  Words gather(const SampleRequest& request, size_t component);
  // Returns one texel, which must lie in the image.
  Words fetch(const TexelIndex& at) { return swizzled(image_, stored(at)); }

  std::span<const Address> texels() const { return {texels_.data(), num_texels_}; }
  const char* error() const { return error_; }  // null: there was none

 private:
  // Holds the levels to read, and the weight of the second.
  struct Levels {
    uint32_t first = 0, second = 0;
    float weight = 0.0f;
  };
  // Holds two neighbours on an axis, and the weight of the second.
  struct Axis {
    int64_t first = 0, second = 0;
    float weight = 0.0f;
  };
  struct Place {
    std::array<float, 3> at;
    uint32_t layer;
    int axes;  // axes that are filtered: 1 to 3
    bool is_cube;
  };
  Levels levels_of(float lod) const;
  Place place_of(const SampleRequest& request) const;
  Axis axis_of(const SampleRequest& request, const Place& place, int axis, uint32_t level, bool linear) const;
  Footprint footprint_of(const SampleRequest& request) const;
  Words filter(const SampleRequest& request, const Place& place, uint32_t level, Filter filter);
  Words filter_levels(const SampleRequest& request, const Levels& levels, Filter filter);
  Words filter_along(const SampleRequest& request, const Footprint& footprint, const Levels& levels,
                     Filter filter);
  // Reads the texels of a linear filter: bit 0 of the index is x, bit 1 is y, bit 2 is z.
  void read_block(const SampleRequest& request, const Place& place, uint32_t level,
                  const std::array<Axis, 3>& axes, std::array<Words, 8>& out);
  Words stored(const TexelIndex& at);
  Words read(const SampleRequest& request, const Place& place, uint32_t level, std::array<int64_t, 3> at);
  Words compared(const SampleRequest& request, Words texel) const;

  const ImageView& image_;
  const Sampler& sampler_;
  const mem::AddressSpace& memory_;
  std::array<Address, kMaxTexels> texels_;
  uint32_t num_texels_ = 0;
  const char* error_ = nullptr;
};

}  // namespace glint::exec
