// Names the kinds of the rows with Effect::Atomic, in their OpRow::detail.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "isa/op_row.h"

namespace glint::isa {

// Names the kinds of atomics that hardware may execute in different ways. Swap is the compare-and-swap, and
// FloatAdd an addition of single or double precision. Everything else is Integer.
enum class AtomicKind : uint8_t { Integer, Swap, FloatAdd };

// Returns whether an atomic gives the old value. With such atomics lanes ask for a lock, or look for a
// change.
inline bool gives_old_value(const OpRow& row) {
  return row.effect == Effect::Atomic && is_destination(row.operands.kind[0]);
}
// Returns whether the atomic is an exchange or a compare-and-swap, which need their old values.
inline bool exchanges(const OpRow& row) {
  return gives_old_value(row) && row.reduction.empty();
}

}  // namespace glint::isa
