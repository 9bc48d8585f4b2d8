// Reads the operands of an image op.
// SPDX-License-Identifier: Apache-2.0
#include "exec/image_operands.h"

#include <fmt/format.h>

namespace glint::exec {

using isa::ImageRequest;

ImageSlots::ImageSlots(const isa::OpRow& row) {
  const isa::ImageAccess& op = row.image;
  for (isa::OperandKind kind : row.operands.view())
    if (isa::is_destination(kind)) results += size_t(isa::slots_of(kind));
  layer = results + 1;
  at = layer + isa::has_layers(op.shape);
  level = at + size_t(isa::num_coordinates(op.shape));
  offset = level;
  if (op.lod == isa::ImageLod::Level) offset += 1;
  if (op.lod == isa::ImageLod::Gradients) offset += 2 * size_t(isa::num_coordinates(op.shape));
  reference = offset + op.has_offset;
  data = level;
}

size_t num_data(const isa::OpRow& row) {
  size_t slots = 0;
  for (isa::OperandKind kind : row.operands.view()) slots += size_t(isa::slots_of(kind));
  return slots - ImageSlots(row).data;
}

SampleRequest request_of(const isa::ImageAccess& op, const ImageSlots& slots, const ImageLane& lane) {
  SampleRequest request;
  request.shape = op.shape;
  const auto count = size_t(isa::num_coordinates(op.shape));
  for (size_t i = 0; i < count; ++i) request.at[i] = lane.number(slots.at + i);
  if (isa::has_layers(op.shape)) request.layer = lane.integer(slots.layer);
  if (op.lod == isa::ImageLod::Level) request.lod = lane.number(slots.level);
  if (op.lod == isa::ImageLod::Gradients) {
    request.has_gradients = true;
    for (size_t i = 0; i < count; ++i) {
      request.dx[i] = lane.number(slots.level + i);
      request.dy[i] = lane.number(slots.level + count + i);
    }
  }
  if (op.has_offset)
    for (size_t i = 0; i < 3; ++i) request.offset[i] = int8_t(lane.word(slots.offset) >> (8 * i));
  request.compare = op.has_compare;
  if (op.has_compare) request.reference = lane.number(slots.reference);
  return request;
}

TexelPlace place_of(const isa::ImageAccess& op, const ImageSlots& slots, const ImageLane& lane,
                    const ImageView& image, uint32_t bytes) {
  TexelPlace place;
  const bool has_level = op.lod == isa::ImageLod::Level;
  const int64_t level = has_level ? lane.integer(slots.level) : 0;
  for (int axis = 0; axis < 3; ++axis) {
    place.at[size_t(axis)] =
        axis < isa::num_coordinates(op.shape) ? lane.integer(slots.at + size_t(axis)) : 0;
    place.end[size_t(axis)] = level < 0 || level >= image.levels ? 0 : image.extent(axis, uint32_t(level));
  }
  if (op.request == ImageRequest::Bytes) place.end[0] = place.end[0] * image.texel_bytes() - (bytes - 1);
  place.at[3] = isa::has_layers(op.shape) ? lane.integer(slots.layer) : 0;
  place.end[3] = image.layers;
  place.level = uint32_t(level);
  return place;
}

std::string describe(const TexelPlace& place, const ImageView& image) {
  return fmt::format(
      "({}, {}, {}) of layer {}, level {}, of image '{}', which is {}x{}x{} with {} layers, {} levels",
      place.at[0], place.at[1], place.at[2], place.at[3], int32_t(place.level), image.name, image.width,
      image.height, image.depth, image.layers, image.levels);
}

}  // namespace glint::exec
