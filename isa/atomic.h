// Names the kinds of the rows with Effect::Atomic, in their OpRow::detail.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace glint::isa {

// Names the kinds of atomics that hardware may execute in different ways. Swap is the compare-and-swap, and
// FloatAdd an addition of single or double precision. Everything else is Integer.
enum class AtomicKind : uint8_t { Integer, Swap, FloatAdd };

}  // namespace glint::isa
