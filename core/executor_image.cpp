// Textures and storage images: filtered fetches and texel accesses on linear images in simulated memory.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/check.h"
#include "core/executor.h"

namespace glint::core {
namespace {

using Texel = std::array<float, 4>;

uint32_t texel_bytes(ImageView::Format format) { return format == ImageView::Format::Rgba8Unorm ? 4 : 16; }

Address texel_address(const ImageView& image, uint32_t x, uint32_t y) {
  return image.base + (uint64_t(y) * image.width + x) * texel_bytes(image.format);
}

Texel decode(const ImageView& image, const std::byte* from) {
  Texel texel;
  if (image.format == ImageView::Format::Rgba32Float) {
    std::memcpy(texel.data(), from, 16);
    return texel;
  }
  // Vulkan, section "Conversion from Normalized Fixed-Point to Floating-Point".
  for (size_t i = 0; i < 4; ++i) texel[i] = float(std::to_integer<uint8_t>(from[i])) / 255.0f;
  return texel;
}

void encode(const ImageView& image, const Texel& texel, std::byte* to) {
  if (image.format == ImageView::Format::Rgba32Float) {
    std::memcpy(to, texel.data(), 16);
    return;
  }
  for (size_t i = 0; i < 4; ++i)  // NaN becomes 0; round to nearest even
    to[i] = std::byte(std::nearbyint(std::max(0.0f, std::min(1.0f, texel[i])) * 255.0f));
}

// One axis of a bilinear fetch with clamp to edge: the two texels and the weight of the second. Coordinates that
// are not numbers count as 0 (Choice: Vulkan leaves them undefined).
struct Axis {
  uint32_t first, second;
  float weight;
};
Axis filter_axis(float coordinate, uint32_t size) {
  const float x = coordinate * float(size) - 0.5f;
  if (!(x > 0.0f)) return {0, 0, 0.0f};
  const float last = float(size - 1);
  if (x >= last) return {size - 1, size - 1, 0.0f};
  const float base = std::floor(x);
  return {uint32_t(base), uint32_t(base) + 1, x - base};
}

}  // namespace

bool Executor::run_image(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  row.run(warp.regs, inst);
  const bool ok = row.effect == isa::Effect::Texture ? sample(warp, inst)
                                                     : access_surface(warp, inst, row.effect == isa::Effect::SurfaceStore);
  if (ok) ++warp.simt.pc;
  return ok;
}

bool Executor::sample(WarpContext& warp, const isa::Inst& inst) {
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const size_t i = size_t(lane);
    const uint64_t handle = warp.regs.access.address[i];
    if (handle >= world_.images.size()) [[unlikely]]
      return fail(warp, lane, fmt::format("samples texture {}: only {} images are bound", handle, world_.images.size()));
    const ImageView& image = world_.images[handle];
    const Axis x = filter_axis(std::bit_cast<float>(warp.regs.access.u[i]), image.width);
    const Axis y = filter_axis(std::bit_cast<float>(warp.regs.access.v[i]), image.height);
    const std::array<Address, 4> at = {texel_address(image, x.first, y.first), texel_address(image, x.second, y.first),
                                       texel_address(image, x.first, y.second), texel_address(image, x.second, y.second)};
    std::array<Texel, 4> texel;
    for (size_t k = 0; k < 4; ++k) {
      const std::byte* from = world_.memory->find(at[k], texel_bytes(image.format));
      if (!from) return fail(warp, lane, fmt::format("samples outside texture {} ({})", handle, image.name));
      texel[k] = decode(image, from);
      texels_[k][i] = at[k];
    }
    for (size_t c = 0; c < 4; ++c) {
      const float top = texel[0][c] * (1.0f - x.weight) + texel[1][c] * x.weight;
      const float bottom = texel[2][c] * (1.0f - x.weight) + texel[3][c] * x.weight;
      warp.regs.write(inst.operand[c])[lane] = std::bit_cast<uint32_t>(top * (1.0f - y.weight) + bottom * y.weight);
    }
  }
  return true;
}

bool Executor::access_surface(WarpContext& warp, const isa::Inst& inst, bool store) {
  for (LaneMask lanes = warp.regs.exec; lanes; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const size_t i = size_t(lane);
    const uint64_t handle = warp.regs.access.address[i];
    if (handle >= world_.images.size()) [[unlikely]]
      return fail(warp, lane, fmt::format("accesses image {}: only {} images are bound", handle, world_.images.size()));
    const ImageView& image = world_.images[handle];
    const uint32_t x = warp.regs.access.u[i], y = warp.regs.access.v[i];
    if (x >= image.width || y >= image.height) [[unlikely]]
      return fail(warp, lane, fmt::format("{} texel ({}, {}) of image '{}', which is {}x{}", store ? "writes" : "reads",
                                          int32_t(x), int32_t(y), image.name, image.width, image.height));
    const Address at = texel_address(image, x, y);
    warp.regs.access.address[i] = at;
    std::byte* memory = world_.memory->find(at, texel_bytes(image.format));
    if (!memory) return fail(warp, lane, fmt::format("image '{}' is smaller than its size says", image.name));
    const size_t first = store ? 3 : 0;  // slots: sust handle, x, y, {4}; suld {4}, handle, x, y
    if (store) {
      Texel texel;
      for (size_t c = 0; c < 4; ++c) texel[c] = std::bit_cast<float>(warp.regs.read(inst.operand[first + c])[lane]);
      encode(image, texel, memory);
    } else {
      const Texel texel = decode(image, memory);
      for (size_t c = 0; c < 4; ++c) warp.regs.write(inst.operand[c])[lane] = std::bit_cast<uint32_t>(texel[c]);
    }
  }
  return true;
}

}  // namespace glint::core
