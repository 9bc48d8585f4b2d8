// Names what the rows of the barrier family ask for, in their OpRow::detail.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace glint::isa {

inline constexpr uint32_t kNumBarriers = 16;  // per block (PTX: barriers 0 to 15)

// Names the kinds of Effect::Barrier.
enum class BarrierKind : uint16_t { Sync, Arrive, Count, And, Or };

// Names the scopes of Effect::Fence: all who see the writes after the fence also see the writes before it.
enum class FenceScope : uint16_t { Warp, Block, Gpu, System };

}  // namespace glint::isa
