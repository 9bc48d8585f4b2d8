// Describes an image in simulated memory: its size, its format, where its texels lie, and how it is sampled.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/types.h"
#include "exec/texture_format.h"
#include "isa/image_access.h"

namespace glint::exec {

enum class Filter : uint8_t { Nearest, Linear };
enum class Wrap : uint8_t { Repeat, MirroredRepeat, ClampToEdge, ClampToBorder, MirrorClampToEdge };
// Says what a filter makes of the texels that have weights above 0: their mean by weight, the least, or the
// greatest.
enum class Reduction : uint8_t { Mean, Least, Greatest };
inline constexpr uint32_t kMaxAnisotropy = 16;  // the most samples of a footprint
enum class Comparison : uint8_t {
  Never,
  Less,
  Equal,
  LessOrEqual,
  Greater,
  NotEqual,
  GreaterOrEqual,
  Always
};

// Corresponds to Vulkan's VkSampler.
struct Sampler {
  Filter mag = Filter::Linear, min = Filter::Linear, mip = Filter::Nearest;
  std::array<Wrap, 3> wrap{Wrap::ClampToEdge, Wrap::ClampToEdge, Wrap::ClampToEdge};
  Words border{};  // bits of floats or integers, as the format has them
  float lod_bias = 0.0f, min_lod = 0.0f, max_lod = 1000.0f;
  bool unnormalized = false;  // coordinates count texels, and only level 0 is read
  Comparison compare = Comparison::Never;
  Reduction reduction = Reduction::Mean;
  float max_anisotropy = 1.0f;  // from 1, which is isotropic, to kMaxAnisotropy
  uint32_t weight_bits = 0;     // bits of a linear filter's weights in each direction; 0: all
  std::string unbound{};        // Not empty: nobody bound the sampler, and this names the place.
};

struct TexelIndex {
  uint32_t x = 0, y = 0, z = 0, layer = 0, level = 0;
};

// Says what a view shows as red, green, blue and alpha.
enum class Component : uint8_t { Red, Green, Blue, Alpha, Zero, One };
using Swizzle = std::array<Component, 4>;
inline constexpr Swizzle kAsStored{Component::Red, Component::Green, Component::Blue, Component::Alpha};

// Names levels and layers of an image. Samples of a texel count as layers.
struct ImageRange {
  uint32_t first_level = 0, levels = 1, first_layer = 0, layers = 1;
};

// Describes an image or a part of one. Model: texels lie in linear rows: x, then y, then z, then layer, then
// level, with nothing between them. Hardware swizzles. A cube has six layers: +x -x +y -y +z -z. Where a
// format has blocks, they lie so in place of texels.
struct ImageView {
  using Format = TexelFormat;
  Format format = Format::Rgba32Float;
  uint32_t width = 1, height = 1;
  Address base = 0;
  std::string name;
  isa::ImageShape shape = isa::ImageShape::D2;
  uint32_t depth = 1, layers = 1, levels = 1;
  uint32_t samples = 1;  // samples of a texel, which are that many layers
  Sampler sampler{};
  bool is_bound = true;  // false: its use is a fault, and `name` names the place
  // With this, and without is_bound, it is no image on purpose (Vulkan's nullDescriptor): reads and queries
  // give 0, and stores are dropped.
  bool is_null = false;
  // A view of some layers begins at layer `first_layer` of `stored_layers` that each level has in memory.
  // With 0, memory holds the view's layers only.
  uint32_t first_layer = 0, stored_layers = 0;
  Swizzle swizzle = kAsStored;  // of textures

  // Returns the bytes of a texel, or of a block of texels.
  uint32_t texel_bytes() const { return info_of(format).bytes; }
  // Returns the texels along an axis of a level: half of the level above, and at least 1.
  uint32_t extent(int axis, uint32_t level) const {
    const uint32_t full = axis == 0 ? width : axis == 1 ? height : depth;
    return level < 32 && full >> level > 1 ? full >> level : 1;
  }
  // Returns the texels or blocks along an axis of a level. Blocks at its end may be in the level in part.
  uint32_t blocks(int axis, uint32_t level) const {
    return blocks_of(extent(axis, level), axis < 2 ? info_of(format).block : 1);
  }
  uint32_t layers_in_memory() const { return stored_layers ? stored_layers : layers; }
  // Returns the bytes of all layers in memory of the levels before `level`. With `levels`, these are the
  // bytes of the image.
  uint64_t bytes_before_level(uint32_t level) const {
    uint64_t blocks_before = 0;
    for (uint32_t l = 0; l < level; ++l)
      blocks_before += blocks_of_slice(l) * extent(2, l) * layers_in_memory();
    return blocks_before * texel_bytes();
  }
  uint64_t bytes() const { return bytes_before_level(levels); }
  // Returns where a texel lies, or the block that holds it.
  Address address_of(const TexelIndex& at) const {
    const uint64_t layer = uint64_t{first_layer} + at.layer;
    const uint64_t slice = layer * extent(2, at.level) + at.z;
    uint64_t columns = extent(0, at.level), x = at.x, y = at.y;
    if (has_blocks()) [[unlikely]] {
      const uint32_t block = info_of(format).block;
      columns = blocks(0, at.level), x /= block, y /= block;
    }
    const uint64_t index = slice * blocks_of_slice(at.level) + y * columns + x;
    return base + bytes_before_level(at.level) + index * texel_bytes();
  }

 private:
  bool has_blocks() const { return format >= kFirstBlockFormat; }
  // Returns the texels or blocks of one slice of a level.
  uint64_t blocks_of_slice(uint32_t level) const {
    if (has_blocks()) [[unlikely]]
      return uint64_t{blocks(0, level)} * blocks(1, level);
    return uint64_t{extent(0, level)} * extent(1, level);
  }
};

// Returns a view of a part of an image, which has to have the part. The part's texels stay where they are.
inline ImageView part_of(const ImageView& image, const ImageRange& range) {
  ImageView part = image;
  part.base += image.bytes_before_level(range.first_level);
  part.width = image.extent(0, range.first_level);
  part.height = image.extent(1, range.first_level);
  part.depth = image.extent(2, range.first_level);
  part.levels = range.levels, part.layers = range.layers;
  part.stored_layers = image.layers_in_memory();
  part.first_layer = image.first_layer + range.first_layer;
  return part;
}

// Returns a texel as the view shows it.
inline Words swizzled(const ImageView& image, const Words& texel) {
  if (image.swizzle == kAsStored) [[likely]]
    return texel;
  Words out;
  for (size_t i = 0; i < 4; ++i)
    out[i] = image.swizzle[i] == Component::Zero  ? 0
             : image.swizzle[i] != Component::One ? texel[size_t(image.swizzle[i])]
             : is_integer(info_of(image.format))  ? 1
                                                  : std::bit_cast<uint32_t>(1.0f);
  return out;
}

}  // namespace glint::exec
