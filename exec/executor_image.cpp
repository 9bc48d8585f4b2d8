// Textures and storage images: what an image op does for the lanes of a warp, with every access checked.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <fmt/format.h>

#include "base/check.h"
#include "exec/executor.h"
#include "exec/texture_address.h"
#include "exec/texture_filter.h"

namespace glint::exec {
namespace {

using isa::ImageRequest;
using isa::ImageShape;

// Slots of an op's operands, in the order that isa/image_access.h gives.
struct Slots {
  explicit Slots(const isa::OpRow& row) {
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
  size_t results = 0, layer, at, level, offset, reference, data;
};

// The operands of one lane.
class Lane {
 public:
  Lane(const isa::Warp& warp, const isa::Inst& inst, int lane) : warp_(warp), inst_(inst), lane_(lane) {}
  uint32_t word(size_t slot) const { return warp_.read(inst_.operand[slot])[lane_]; }
  int32_t integer(size_t slot) const { return int32_t(word(slot)); }
  // An atomic's operand: a pair of registers where it changes 64 bits.
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

SampleRequest request_of(const isa::ImageAccess& op, const Slots& slots, const Lane& lane,
                         const ImageView& image) {
  SampleRequest request;
  request.shape = op.shape;
  const auto count = size_t(isa::num_coordinates(op.shape));
  for (size_t i = 0; i < count; ++i) request.at[i] = lane.number(slots.at + i);
  if (isa::has_layers(op.shape)) request.layer = lane.integer(slots.layer);
  if (op.lod == isa::ImageLod::Level) request.lod = lane.number(slots.level);
  if (op.lod == isa::ImageLod::Gradients) {
    Gradient dx{}, dy{};
    for (size_t i = 0; i < count; ++i) {
      dx[i] = lane.number(slots.level + i);
      dy[i] = lane.number(slots.level + count + i);
    }
    const bool cube = isa::is_cube(op.shape);
    if (cube) dx = cube_gradient(request.at, dx), dy = cube_gradient(request.at, dy);
    request.lod = level_of_detail(image, cube ? 2 : int(count), dx, dy);
  }
  if (op.has_offset)
    for (size_t i = 0; i < 3; ++i) request.offset[i] = int8_t(lane.word(slots.offset) >> (8 * i));
  request.compare = op.has_compare;
  if (op.has_compare) request.reference = lane.number(slots.reference);
  return request;
}

// Whether an op of geometry `op` may work on the image. Surface ops see a cube as an array of its faces.
bool fits(const isa::ImageAccess& op, ImageShape image) {
  const auto is_texture = op.request == ImageRequest::Sample || op.request == ImageRequest::Gather;
  const auto axes = [](ImageShape s) { return isa::is_cube(s) ? 2 : isa::num_coordinates(s); };
  if ((op.shape == ImageShape::Buffer) != (image == ImageShape::Buffer)) return false;
  if (isa::is_cube(op.shape)) return isa::is_cube(image);
  return axes(op.shape) == axes(image) && !(is_texture && isa::is_cube(image));
}

std::string_view name_of(ImageShape shape) {
  constexpr std::string_view kNames[] = {"buffer", "1d", "2d", "3d", "a1d", "a2d", "cube", "acube"};
  return kNames[size_t(shape)];
}

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

// A texel that an integer coordinate names: x, y, z, and layer, and how much there is of each. Byte accesses
// count x in bytes.
struct Place {
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
Place place_of(const isa::ImageAccess& op, const Slots& slots, const Lane& lane, const ImageView& image,
               uint32_t bytes) {
  Place place;
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

std::string outside(const Place& place, const ImageView& image) {
  return fmt::format(
      "({}, {}, {}) of layer {}, level {}, of image '{}', which is {}x{}x{} with {} layers, {} levels",
      place.at[0], place.at[1], place.at[2], place.at[3], int32_t(place.level), image.name, image.width,
      image.height, image.depth, image.layers, image.levels);
}

// Words that a surface op stores, or takes besides its place.
size_t num_data(const isa::OpRow& row) {
  size_t slots = 0;
  for (isa::OperandKind kind : row.operands.view()) slots += size_t(isa::slots_of(kind));
  return slots - Slots(row).data;
}

void store_texel(const isa::OpRow& row, TexelFormat format, const Words& words, std::byte* at) {
  if (row.image.request == ImageRequest::Texel) return encode(format, words, at);
  std::memcpy(at, words.data(), size_t(row.memory.bytes * row.memory.count));
}

}  // namespace

Words load_texel(const isa::OpRow& row, TexelFormat format, const std::byte* at) {
  if (row.image.request == ImageRequest::Texel) return decode(format, at);
  Words words{};
  std::memcpy(words.data(), at, size_t(row.memory.bytes * row.memory.count));
  return words;
}

// Null: nothing is there, let pass (`fault()` is then not set) or not.
const ImageView* Executor::find_image(WarpContext& warp, const isa::OpRow& row, int lane) {
  const uint64_t handle = warp.regs.access.address[size_t(lane)];
  const uint64_t number = handle % (1u << isa::kHandleSamplerShift),
                 sampler = handle >> isa::kHandleSamplerShift;
  if (number >= world_.images.size() || sampler > world_.samplers.size()) [[unlikely]] {
    let_pass(warp, lane, FaultKind::Image, [&] {
      return fmt::format("uses image {} with sampler {}: {} images and {} samplers are bound", number,
                         sampler, world_.images.size(), world_.samplers.size());
    });
    return nullptr;
  }
  const ImageView& image = world_.images[number];
  const bool filters = row.image.request == ImageRequest::Sample || row.image.request == ImageRequest::Gather;
  const std::string& unbound = !image.is_bound ? image.name : find_sampler(image, handle).unbound;
  if (!image.is_bound || (filters && !unbound.empty())) [[unlikely]] {
    let_pass(warp, lane, FaultKind::Image,
             [&] { return fmt::format("uses {}, to which nothing is bound", unbound); });
    return nullptr;
  }
  if (row.image.request != ImageRequest::Query && !fits(row.image, image.shape)) [[unlikely]] {
    let_pass(warp, lane, FaultKind::Image, [&] {
      return fmt::format("uses image '{}', which is {}, as {}", image.name, name_of(image.shape),
                         name_of(row.image.shape));
    });
    return nullptr;
  }
  return &image;
}

const Sampler& Executor::find_sampler(const ImageView& image, Address handle) const {
  const uint64_t sampler = handle >> isa::kHandleSamplerShift;
  return sampler ? world_.samplers[sampler - 1] : image.sampler;
}

bool Executor::run_image(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  row.run(warp.regs, inst);
  texels_.clear();
  is_late_ = false;
  bool ok = false;
  switch (row.image.request) {
    case ImageRequest::Sample:
    case ImageRequest::Gather:
    case ImageRequest::Fetch:
      ok = texture(warp, inst, row);
      break;
    case ImageRequest::Query:
      ok = query_image(warp, inst, row);
      break;
    case ImageRequest::Texel:
    case ImageRequest::Bytes:
      ok = surface(warp, inst, row);
      break;
    case ImageRequest::None:
      GLINT_PANIC("{} is not an image op", row.name);
  }
  if (ok) ++warp.simt.pc;
  return ok;
}

bool Executor::texture(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  const isa::ImageAccess& op = row.image;
  const Slots slots(row);
  std::array<Words, kLanes> result;  // written when no lane can fault any more
  const auto pass = [&](int lane, const auto& what) { return let_pass(warp, lane, FaultKind::Image, what); };
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    Words& out = result[size_t(lane)] = {};
    const ImageView* image = find_image(warp, row, lane);
    if (!image && fault_) return false;
    if (!image) continue;
    if (is_integer(info_of(image->format)) == op.is_float) [[unlikely]] {
      if (!pass(lane, [&] {
            return fmt::format("reads {} from image '{}', whose format is {}",
                               op.is_float ? "floats" : "integers", image->name, info_of(image->format).name);
          }))
        return false;
      continue;
    }
    TexelReader reader(*image, find_sampler(*image, warp.regs.access.address[size_t(lane)]), *world_.memory);
    const Lane operands(warp.regs, inst, lane);
    if (op.request == ImageRequest::Fetch) {
      const Place place = place_of(op, slots, operands, *image, 0);
      if (place.is_inside())
        out = reader.fetch(place.index());
      else if (!world_.robust_images && !pass(lane, [&] { return "reads texel " + outside(place, *image); }))
        return false;
    } else {
      const SampleRequest request = request_of(op, slots, operands, *image);
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

bool Executor::query_image(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  const Slots slots(row);
  std::array<uint32_t, kLanes> result;
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    result[size_t(lane)] = 0;
    const ImageView* image = find_image(warp, row, lane);
    if (!image && fault_) return false;
    if (!image) continue;
    const uint32_t level = row.image.lod == isa::ImageLod::Level ? warp.regs.read(inst.operand[2])[lane] : 0;
    const Sampler& sampler = find_sampler(*image, warp.regs.access.address[size_t(lane)]);
    result[size_t(lane)] = answer(row.image, *image, sampler, level);
  }
  uint32_t* const to = warp.regs.write(inst.operand[0]);
  for_each_lane(warp.regs.exec, [&](int lane) { to[lane] = result[size_t(lane)]; });
  return true;
}

// Where a lane's surface op goes: null, with a fault or without one, when it goes nowhere. It then loads 0.
std::byte* Executor::find_texel(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, int lane) {
  const isa::ImageAccess& op = row.image;
  const ImageView* image = find_image(warp, row, lane);
  if (!image) return nullptr;
  const bool whole = op.request == ImageRequest::Texel;
  const uint32_t bytes = whole ? image->texel_bytes() : uint32_t(row.memory.bytes * row.memory.count);
  Place place = place_of(op, Slots(row), Lane(warp.regs, inst, lane), *image, bytes);
  const auto refuse = [&](const auto& what) -> std::byte* {
    return let_pass(warp, lane, FaultKind::Image, what), nullptr;
  };
  if (!whole && place.at[0] % bytes != 0)
    return refuse([&] {
      return fmt::format("accesses {} bytes at byte {} of a row of image '{}'", bytes, place.at[0],
                         image->name);
    });
  // Texels of 64 bits are two channels of 32: their low half and their high one.
  if (row.atomic && whole && (info_of(image->format).bits != 32 || image->texel_bytes() != row.memory.bytes))
    return refuse([&] {
      return fmt::format("atomic on image '{}', whose format is {}", image->name,
                         info_of(image->format).name);
    });
  if (!place.is_inside()) [[unlikely]] {
    if (op.outside == isa::ImageOutside::Clamp && place.end[0] > 0) {
      for (size_t i = 0; i < 4; ++i) place.at[i] = std::clamp<int64_t>(place.at[i], 0, place.end[i] - 1);
      if (!whole) place.at[0] -= place.at[0] % bytes;
    } else if (op.outside == isa::ImageOutside::Zero || world_.robust_images) {
      return nullptr;
    } else {
      const bool store = row.effect != isa::Effect::SurfaceLoad;
      return refuse([&] { return (store ? "writes texel " : "reads texel ") + outside(place, *image); });
    }
  }
  TexelIndex index = place.index();
  const uint32_t skipped = whole ? 0 : index.x;  // bytes of the row
  if (!whole) index.x = 0;
  const Address at = image->address_of(index) + skipped;
  std::byte* const memory = world_.memory->find(at, bytes);
  if (!memory)
    return refuse(
        [&] { return fmt::format("image '{}' is smaller in memory than its size says", image->name); });
  texels_.add(lane, {&at, 1});
  return memory;
}

bool Executor::surface(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  const Slots slots(row);
  const size_t end = slots.data + num_data(row);
  std::array<std::byte*, kLanes> place{};
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    place[size_t(lane)] = find_texel(warp, inst, row, lane);
    if (!place[size_t(lane)] && fault_) return false;
  }
  const auto format_of = [&](int lane) {
    return world_.images[warp.regs.access.address[size_t(lane)] % (1u << isa::kHandleSamplerShift)].format;
  };
  if (view_) return surface_seen(warp, inst, row, place), true;
  // Lane by lane: atomics take turns; of stores to one texel the highest lane's stays. Choice: PTX leaves it
  // open.
  for_each_lane(warp.regs.exec, [&](int lane) {
    const Lane operands(warp.regs, inst, lane);
    std::byte* const at = place[size_t(lane)];
    Words words{};
    if (row.effect == isa::Effect::SurfaceStore) {
      for (size_t c = slots.data; c < end; ++c) words[c - slots.data] = operands.word(c);
      if (at) store_texel(row, format_of(lane), words, at);
      return;
    }
    if (row.effect == isa::Effect::SurfaceAtomic) {
      const uint64_t operand = operands.bits(slots.data, row),
                     swap = slots.data + 1 < end ? operands.bits(slots.data + 1, row) : 0;
      if (at) {
        uint64_t old = 0;
        std::memcpy(&old, at, row.memory.bytes);
        const uint64_t kept = row.atomic(old, operand, swap);
        std::memcpy(at, &kept, row.memory.bytes);
        words[0] = uint32_t(old), words[1] = uint32_t(old >> 32);
      }
      if (row.memory.bytes == 8) warp.regs.write(isa::Slot(inst.operand[0] + 1))[lane] = words[1];
    } else if (at) {
      words = load_texel(row, format_of(lane), at);
    }
    for (size_t c = 0; c < slots.results; ++c) warp.regs.write(inst.operand[c])[lane] = words[c];
  });
  return true;
}

// surface() where the image is seen through view_. A lane without a place loads 0.
void Executor::surface_seen(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row,
                            const Places& place) {
  const Slots slots(row);
  const auto format_of = [&](int lane) {
    return world_.images[warp.regs.access.address[size_t(lane)] % (1u << isa::kHandleSamplerShift)].format;
  };
  const auto bytes_of = [&](int lane) {
    return row.image.request == ImageRequest::Texel ? uint32_t(info_of(format_of(lane)).bytes)
                                                    : uint32_t(row.memory.bytes * row.memory.count);
  };
  const auto to = [&](size_t c, int lane) {
    return c < slots.results ? warp.regs.write(inst.operand[c]) + lane : nullptr;
  };
  is_late_ = row.effect == isa::Effect::SurfaceAtomic && slots.results > 0;
  if (row.effect == isa::Effect::SurfaceLoad)
    for_each_lane(warp.regs.exec, [&](int lane) {
      is_late_ |= place[size_t(lane)] && view_->waits(place[size_t(lane)], bytes_of(lane));
    });
  for_each_lane(warp.regs.exec, [&](int lane) {
    const Lane operands(warp.regs, inst, lane);
    std::byte* const at = place[size_t(lane)];
    std::array<std::byte, MemoryView::kWidest> scratch{};
    if (row.effect == isa::Effect::SurfaceStore && at) {
      Words words{};
      for (size_t c = 0; c < num_data(row); ++c) words[c] = operands.word(slots.data + c);
      store_texel(row, format_of(lane), words, scratch.data());
      view_->store(at, scratch.data(), bytes_of(lane));
    } else if (row.effect == isa::Effect::SurfaceAtomic && at) {
      const uint64_t swap = num_data(row) > 1 ? operands.bits(slots.data + 1, row) : 0;
      view_->modify({at, row.atomic, operands.bits(slots.data, row), swap, row.memory.bytes, to(0, lane)});
    } else if (row.effect == isa::Effect::SurfaceLoad && at && is_late_) {
      view_->load(MemoryView::LoadTexel{
          at, &row, format_of(lane), {to(0, lane), to(1, lane), to(2, lane), to(3, lane)}});
    } else {
      const Words words =
          at ? load_texel(row, format_of(lane), view_->read(at, bytes_of(lane), scratch)) : Words{};
      for (size_t c = 0; c < slots.results; ++c) *to(c, lane) = words[c];
    }
  });
}

}  // namespace glint::exec
