// Reads the operands of an image op: coordinates, level of detail, data, and the texel that they name.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <bit>
#include <cstdint>
#include <string>

#include "exec/image_view.h"
#include "exec/texture_filter.h"
#include "isa/op_row.h"

namespace glint::exec {

// Holds the slots of an op's operands, in the order that isa/image_access.h gives.
struct ImageSlots {
  explicit ImageSlots(const isa::OpRow& row);
  size_t results = 0, layer, at, level, offset, reference, data;
};

// Returns the number of words that a surface op stores, or takes besides its place.
size_t num_data(const isa::OpRow& row);

// Reads the operands of one lane.
class ImageLane {
 public:
  ImageLane(const isa::Warp& warp, const isa::Inst& inst, int lane) : warp_(warp), inst_(inst), lane_(lane) {}
  uint32_t word(size_t slot) const { return warp_.read(inst_.operand[slot])[lane_]; }
  int32_t integer(size_t slot) const { return int32_t(word(slot)); }
  // Returns an atomic's operand, which is a pair of registers when the atomic changes 64 bits.
  uint64_t bits(size_t slot, const isa::OpRow& row) const {
    const uint64_t high = row.memory.bytes == 8 ? warp_.read(isa::Slot(inst_.operand[slot] + 1))[lane_] : 0;
    return word(slot) | high << 32;
  }
  float number(size_t slot) const { return std::bit_cast<float>(word(slot)); }

 private:
  const isa::Warp& warp_;
  const isa::Inst& inst_;
  int lane_;
};

// Returns what a sampling op asks of an image for one lane.
SampleRequest request_of(const isa::ImageAccess& op, const ImageSlots& slots, const ImageLane& lane);

// Holds the texel that integer coordinates name: x, y, z and layer, with the number of texels along each.
// Byte accesses count x in bytes.
struct TexelPlace {
  std::array<int64_t, 4> at{}, end{};
  uint32_t level = 0;
  TexelIndex index() const {
    return {uint32_t(at[0]), uint32_t(at[1]), uint32_t(at[2]), uint32_t(at[3]), level};
  }
  bool is_inside() const {
    for (size_t i = 0; i < 4; ++i)
      if (at[i] < 0 || at[i] >= end[i]) return false;
    return true;
  }
};
TexelPlace place_of(const isa::ImageAccess& op, const ImageSlots& slots, const ImageLane& lane,
                    const ImageView& image, uint32_t bytes);

// Says for messages which texel it is, and how large its image is.
std::string describe(const TexelPlace& place, const ImageView& image);

}  // namespace glint::exec
