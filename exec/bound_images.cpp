// Finds the image of a handle, and reports handles that name none.
// SPDX-License-Identifier: Apache-2.0
#include "exec/bound_images.h"

#include <fmt/format.h>
#include <iterator>
#include <string>
#include <string_view>

#include "isa/image_access.h"

namespace glint::exec {

using isa::ImageRequest;
using isa::ImageShape;

namespace {

// Returns whether an op of geometry `op` may work on the image. Surface ops see a cube as an array of its
// faces.
bool fits(const isa::ImageAccess& op, ImageShape image) {
  const auto is_texture = op.request == ImageRequest::Sample || op.request == ImageRequest::Gather;
  const auto axes = [](ImageShape s) { return isa::is_cube(s) ? 2 : isa::num_coordinates(s); };
  if ((op.shape == ImageShape::Buffer) != (image == ImageShape::Buffer)) return false;
  if (isa::is_cube(op.shape)) return isa::is_cube(image);
  return axes(op.shape) == axes(image) && !(is_texture && isa::is_cube(image));
}

std::string_view name_of(ImageShape shape) {
  constexpr std::string_view kNames[] = {"buffer", "1d", "2d", "3d", "a1d", "a2d", "cube", "acube"};
  static_assert(std::size(kNames) == size_t(ImageShape::Acube) + 1);
  return kNames[size_t(shape)];
}

}  // namespace

const ImageView* BoundImages::find(const WarpContext& warp, const isa::OpRow& row, int lane) {
  const uint64_t handle = warp.regs.access.address[size_t(lane)];
  const uint64_t number = handle % (1u << isa::kHandleSamplerShift),
                 sampler = handle >> isa::kHandleSamplerShift;
  if (number >= world_.num_images() || sampler > world_.num_samplers()) [[unlikely]] {
    faults_.let_pass(warp, lane, FaultKind::Image, [&] {
      return fmt::format("uses image {} with sampler {}, and {} images and {} samplers are bound", number,
                         sampler, world_.num_images(), world_.num_samplers());
    });
    return nullptr;
  }
  const ImageView& image = world_.image_at(number);
  const bool filters = row.image.request == ImageRequest::Sample || row.image.request == ImageRequest::Gather;
  const std::string& unbound = !image.is_bound ? image.name : sampler_of(image, handle).unbound;
  if (!image.is_bound || (filters && !unbound.empty())) [[unlikely]] {
    if (!image.is_bound && image.is_null) return nullptr;
    faults_.let_pass(warp, lane, FaultKind::Image,
                     [&] { return fmt::format("uses {}, to which nothing is bound", unbound); });
    return nullptr;
  }
  if (row.image.request != ImageRequest::Query && !fits(row.image, image.shape)) [[unlikely]] {
    faults_.let_pass(warp, lane, FaultKind::Image, [&] {
      return fmt::format("uses image '{}', which is {}, as {}", image.name, name_of(image.shape),
                         name_of(row.image.shape));
    });
    return nullptr;
  }
  return &image;
}

const Sampler& BoundImages::sampler_of(const ImageView& image, Address handle) const {
  const uint64_t sampler = handle >> isa::kHandleSamplerShift;
  return sampler ? world_.sampler_at(sampler - 1) : image.sampler;
}

}  // namespace glint::exec
