// Names what the rows of the barrier family ask for, in their OpRow::detail.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

#include "isa/op_row.h"

namespace glint::isa {

inline constexpr uint32_t kNumBarriers = 16;  // per block (PTX: barriers 0 to 15)

// Names the kinds of Effect::Barrier.
enum class BarrierKind : uint16_t { Sync, Arrive, Count, And, Or };

// Names the scopes of Effect::Fence: all who see the writes after the fence also see the writes before it.
enum class FenceScope : uint16_t { Warp, Block, Gpu, System };

// Returns whether lanes come together for the op whose last operand is a mask of these lanes. Ops that are
// .aligned have no mask: a program has all lanes execute them together.
inline bool has_lane_mask(const OpRow& row) {
  return (row.effect == Effect::None || row.effect == Effect::Fence) &&
         row.name.find(".sync") != std::string_view::npos &&
         row.name.find(".aligned") == std::string_view::npos;
}

}  // namespace glint::isa
