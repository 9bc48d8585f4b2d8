// What the rows of the barrier family ask for: their OpRow::detail.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace glint::isa {

inline constexpr uint32_t kNumBarriers = 16;  // of a block (PTX: barriers 0 to 15)

// Of Effect::Barrier.
enum class BarrierKind : uint16_t { Sync, Arrive, Count, And, Or };

// Of Effect::Fence: who sees the writes before it before those after it.
enum class FenceScope : uint16_t { Warp, Block, Gpu, System };

}  // namespace glint::isa
