// Runs texture ops of a warp, with a check of every access.
// SPDX-License-Identifier: Apache-2.0
#include "exec/texture_ops.h"

#include <bit>
#include <fmt/format.h>

#include "base/check.h"
#include "exec/image_operands.h"
#include "exec/texture_filter.h"

namespace glint::exec {

using isa::ImageRequest;

namespace {

uint32_t answer(const isa::ImageAccess& op, const ImageView& image, const Sampler& sampler, uint32_t level) {
  switch (op.query) {
    case isa::ImageQuery::Width:
      return image.extent(0, level);
    case isa::ImageQuery::Height:
      return image.extent(1, level);
    case isa::ImageQuery::Depth:
      return image.extent(2, level);
    case isa::ImageQuery::ArraySize:
      return image.layers / (isa::is_cube(image.shape) ? 6 : image.samples);
    case isa::ImageQuery::NumMipmapLevels:
      return image.levels;
    case isa::ImageQuery::NumSamples:
      return image.samples;
    case isa::ImageQuery::NormalizedCoords:
      return sampler.unnormalized ? 0 : 1;
    case isa::ImageQuery::ChannelDataType:
      return info_of(image.format).opencl_type;
    case isa::ImageQuery::ChannelOrder:
      return info_of(image.format).opencl_order;
  }
  GLINT_PANIC("image query {}", int(op.query));
}

}  // namespace

bool TextureOps::read(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  const isa::ImageAccess& op = row.image;
  const ImageSlots slots(row);
  std::array<Words, kLanes> result;  // It is written when no lane can fault any more.
  const auto pass = [&](int lane, const auto& what) {
    return faults_.let_pass(warp, lane, FaultKind::Image, what);
  };
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    Words& out = result[size_t(lane)] = {};
    const ImageView* image = images_.find(warp, row, lane);
    if (!image && faults_.fault()) return false;
    if (!image) continue;
    if (is_integer(info_of(image->format)) == op.is_float) [[unlikely]] {
      if (!pass(lane, [&] {
            return fmt::format("reads {} from image '{}', whose format is {}",
                               op.is_float ? "floats" : "integers", image->name, info_of(image->format).name);
          }))
        return false;
      continue;
    }
    seen_.read_as_it_is(image->base);
    TexelReader reader(*image, images_.sampler_of(*image, warp.regs.access.address[size_t(lane)]),
                       *world_.memory);
    const ImageLane operands(warp.regs, inst, lane);
    if (op.request == ImageRequest::Fetch) {
      const TexelPlace place = place_of(op, slots, operands, *image, 0);
      if (place.is_inside())
        out = reader.fetch(place.index());
      else if (world_.robust_images)
        out = swizzled(*image, keep_channels(image->format, {}));
      else if (!pass(lane, [&] { return "reads texel " + describe(place, *image); }))
        return false;
    } else {
      const SampleRequest request = request_of(op, slots, operands);
      out =
          op.request == ImageRequest::Gather ? reader.gather(request, op.component) : reader.sample(request);
    }
    if (reader.error()) [[unlikely]] {
      if (!pass(lane,
                [&] { return fmt::format("samples image '{}', which {}", image->name, reader.error()); }))
        return false;
      out = {};
      continue;
    }
    texels_.add(lane, reader.texels());
  }
  for (size_t c = 0; c < slots.results; ++c) {
    uint32_t* const to = warp.regs.write(inst.operand[c]);
    for_each_lane(warp.regs.exec, [&](int lane) { to[lane] = result[size_t(lane)][c]; });
  }
  return true;
}

bool TextureOps::query(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  const ImageSlots slots(row);
  std::array<uint32_t, kLanes> result;
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    result[size_t(lane)] = 0;
    const ImageView* image = images_.find(warp, row, lane);
    if (!image && faults_.fault()) return false;
    if (!image) continue;
    const uint32_t level = row.image.lod == isa::ImageLod::Level ? warp.regs.read(inst.operand[2])[lane] : 0;
    const Sampler& sampler = images_.sampler_of(*image, warp.regs.access.address[size_t(lane)]);
    result[size_t(lane)] = answer(row.image, *image, sampler, level);
  }
  uint32_t* const to = warp.regs.write(inst.operand[0]);
  for_each_lane(warp.regs.exec, [&](int lane) { to[lane] = result[size_t(lane)]; });
  return true;
}

}  // namespace glint::exec
