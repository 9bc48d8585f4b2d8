// Describes what a texture or surface op asks of its image. The texture unit reads this part of an op's row.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace glint::isa {

// Names PTX's geometries, 1d 2d 3d a1d a2d cube acube (a: array), and Vulkan's texel buffers.
enum class ImageShape : uint8_t { Buffer, D1, D2, D3, A1d, A2d, Cube, Acube };
constexpr bool is_cube(ImageShape s) {
  return s == ImageShape::Cube || s == ImageShape::Acube;
}
constexpr bool has_layers(ImageShape s) {
  return s == ImageShape::A1d || s == ImageShape::A2d || s == ImageShape::Acube;
}
// Returns the number of coordinate operands without the layer, which comes before them.
constexpr int num_coordinates(ImageShape s) {
  if (s == ImageShape::D3 || is_cube(s)) return 3;
  return s == ImageShape::D2 || s == ImageShape::A2d ? 2 : 1;
}

enum class ImageRequest : uint8_t {
  None,
  Sample,  // tex with float coordinates
  Fetch,   // tex with integer coordinates: one texel, no filter
  Gather,  // tld4
  Query,   // txq, suq
  Texel,   // suld.p, sust.p: a texel in the image's format; suatom: its one word
  Bytes,   // suld.b, sust.b, sured.b: unconverted bits; x counts bytes
};
enum class ImageLod : uint8_t { Zero, Level, Gradients };  // tex, tex.level, tex.grad
// Says what a surface op does outside of the image: .trap .clamp .zero.
enum class ImageOutside : uint8_t { Trap, Clamp, Zero };
enum class ImageQuery : uint8_t {
  Width,
  Height,
  Depth,
  ArraySize,
  NumMipmapLevels,
  NumSamples,
  NormalizedCoords,
  ChannelDataType,
  ChannelOrder
};

// The operands after the destination are: handle; layer of arrays (s32); coordinates; level (float for
// Sample, s32 for Fetch and Query) or both gradients; offsets (bytes x, y, z of one register, signed);
// reference value; data of stores.
struct ImageAccess {
  ImageRequest request = ImageRequest::None;
  ImageShape shape = ImageShape::D2;
  ImageLod lod = ImageLod::Zero;
  bool is_float = true;  // Sample, Fetch, Gather: results are floats; otherwise integers
  bool has_offset = false;
  bool has_compare = false;  // texels are compared with the reference before they are filtered
  uint8_t component = 0;     // Gather
  ImageOutside outside = ImageOutside::Trap;
  ImageQuery query = ImageQuery::Width;
};

// A handle holds the image's number and, from this bit on, 0 for the image's own sampler or 1 + the number of
// another.
inline constexpr int kHandleSamplerShift = 20;

}  // namespace glint::isa
