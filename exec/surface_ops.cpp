// Runs surface ops of a warp, with a check of every access.
// SPDX-License-Identifier: Apache-2.0
#include "exec/surface_ops.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <fmt/format.h>

#include "exec/image_operands.h"

namespace glint::exec {

using isa::ImageRequest;

namespace {

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

// Notes a texel's store when a channel that was stored is not finite. Most are finite, so it costs no more
// than to look at them.
void SurfaceOps::note_not_finite(const WarpContext& warp, int lane, TexelFormat format,
                                 const std::byte* stored) {
  if (info_of(format).numeric != Numeric::Float) return;
  const Words words = decode(format, stored);
  if (std::all_of(words.begin(), words.end(), [](uint32_t word) { return std::isfinite(float_of(word)); }))
    return;
  not_finite_.note(texels_.rows()[0][size_t(lane)], {seen_.is_used() ? seen_.view().now() : 0, warp.simt.pc});
}

// Returns where a lane's surface op goes. Null, with a fault or without one, says that it goes nowhere. It
// then loads what nowhere() says.
std::byte* SurfaceOps::find_texel(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, int lane) {
  const isa::ImageAccess& op = row.image;
  const ImageView* image = images_.find(warp, row, lane);
  if (!image) return nullptr;
  const bool whole = op.request == ImageRequest::Texel;
  const uint32_t bytes = whole ? image->texel_bytes() : uint32_t(row.memory.bytes * row.memory.count);
  TexelPlace place = place_of(op, ImageSlots(row), ImageLane(warp.regs, inst, lane), *image, bytes);
  const auto refuse = [&](const auto& what) -> std::byte* {
    return faults_.let_pass(warp, lane, FaultKind::Image, what), nullptr;
  };
  if (info_of(image->format).block > 1) [[unlikely]]
    return refuse([&] {
      return fmt::format("uses image '{}' as a storage image, and its format {} can only be sampled",
                         image->name, info_of(image->format).name);
    });
  if (!whole && place.at[0] % bytes != 0)
    return refuse([&] {
      return fmt::format("accesses {} bytes at byte {} of a row of image '{}'", bytes, place.at[0],
                         image->name);
    });
  // Texels of 64 bits have two channels of 32: their low half and their high half.
  if (row.atomic && whole && (info_of(image->format).bits != 32 || image->texel_bytes() != row.memory.bytes))
    return refuse([&] {
      return fmt::format("atomic on image '{}', whose format is {}", image->name,
                         info_of(image->format).name);
    });
  if (!place.is_inside()) [[unlikely]] {
    if (op.outside == isa::ImageOutside::Clamp && place.end[0] > 0) {
      for (size_t i = 0; i < 4; ++i) place.at[i] = std::clamp<int64_t>(place.at[i], 0, place.end[i] - 1);
      if (!whole) place.at[0] -= place.at[0] % bytes;
    } else if (world_.robust_images) {
      outside_ |= LaneMask{1} << lane;
      return nullptr;
    } else if (op.outside == isa::ImageOutside::Zero) {
      return nullptr;
    } else {
      const bool store = row.effect != isa::Effect::SurfaceLoad;
      return refuse([&] { return (store ? "writes texel " : "reads texel ") + describe(place, *image); });
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
  return seen_.place(at, memory, bytes, row.effect);
}

// Returns what a load gives that goes nowhere: 0. Channels that the image's format lacks are those of every
// texel when accesses outside of images are robust (Vulkan's robustImageAccess2).
Words SurfaceOps::nowhere(const WarpContext& warp, const isa::OpRow& row, int lane) const {
  const bool is_texel = row.effect == isa::Effect::SurfaceLoad && row.image.request == ImageRequest::Texel;
  return is_texel && (outside_ >> lane & 1) ? keep_channels(images_.format_of(warp, lane), {}) : Words{};
}

bool SurfaceOps::run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  outside_ = 0;
  const ImageSlots slots(row);
  const size_t end = slots.data + num_data(row);
  LanePlaces place{};
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    place[size_t(lane)] = find_texel(warp, inst, row, lane);
    if (!place[size_t(lane)] && faults_.fault()) return false;
  }
  if (seen_.is_used()) return run_seen(warp, inst, row, place), true;
  // Lanes run one by one: atomics take turns, and when several lanes store to one texel, the store of the
  // highest lane stays. Choice: PTX leaves it open.
  for_each_lane(warp.regs.exec, [&](int lane) {
    const ImageLane operands(warp.regs, inst, lane);
    std::byte* const at = place[size_t(lane)];
    Words words = at ? Words{} : nowhere(warp, row, lane);
    if (row.effect == isa::Effect::SurfaceStore) {
      for (size_t c = slots.data; c < end; ++c) words[c - slots.data] = operands.word(c);
      if (!at) return;
      const TexelFormat format = images_.format_of(warp, lane);
      store_texel(row, format, words, at);
      if (row.image.request == ImageRequest::Texel) note_not_finite(warp, lane, format, at);
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
      words = load_texel(row, images_.format_of(warp, lane), at);
    }
    for (size_t c = 0; c < slots.results; ++c) warp.regs.write(inst.operand[c])[lane] = words[c];
  });
  return true;
}

// Does what run() does when the image is seen through a view.
void SurfaceOps::run_seen(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row,
                          const LanePlaces& place) {
  const ImageSlots slots(row);
  const auto bytes_of = [&](int lane) {
    return row.image.request == ImageRequest::Texel ? uint32_t(info_of(images_.format_of(warp, lane)).bytes)
                                                    : uint32_t(row.memory.bytes * row.memory.count);
  };
  const auto to = [&](size_t c, int lane) {
    return c < slots.results ? warp.regs.write(inst.operand[c]) + lane : nullptr;
  };
  bool is_late = row.effect == isa::Effect::SurfaceAtomic && slots.results > 0;
  if (row.effect == isa::Effect::SurfaceLoad)
    for_each_lane(warp.regs.exec, [&](int lane) {
      is_late |= place[size_t(lane)] && seen_.view().waits(place[size_t(lane)], bytes_of(lane));
    });
  seen_.be_late(is_late);
  const size_t num_words = num_data(row);
  for_each_lane(warp.regs.exec, [&](int lane) {
    const ImageLane operands(warp.regs, inst, lane);
    std::byte* const at = place[size_t(lane)];
    std::array<std::byte, MemoryView::kWidest> scratch{};
    if (row.effect == isa::Effect::SurfaceStore && at) {
      Words words{};
      for (size_t c = 0; c < num_words; ++c) words[c] = operands.word(slots.data + c);
      const TexelFormat format = images_.format_of(warp, lane);
      store_texel(row, format, words, scratch.data());
      if (row.image.request == ImageRequest::Texel) note_not_finite(warp, lane, format, scratch.data());
      seen_.view().store(at, scratch.data(), bytes_of(lane));
    } else if (row.effect == isa::Effect::SurfaceAtomic && at) {
      const uint64_t swap = num_words > 1 ? operands.bits(slots.data + 1, row) : 0;
      seen_.view().modify(
          {at, row.atomic, operands.bits(slots.data, row), swap, row.memory.bytes, to(0, lane)});
    } else if (row.effect == isa::Effect::SurfaceLoad && at && is_late) {
      seen_.view().load(MemoryView::LoadTexel{
          at, &row, images_.format_of(warp, lane), {to(0, lane), to(1, lane), to(2, lane), to(3, lane)}});
    } else {
      const Words words =
          at ? load_texel(row, images_.format_of(warp, lane), seen_.view().read(at, bytes_of(lane), scratch))
             : nowhere(warp, row, lane);
      for (size_t c = 0; c < slots.results; ++c) *to(c, lane) = words[c];
    }
  });
}

}  // namespace glint::exec
