// Counts registers.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>

#include "frontend/virtual_program.h"

namespace glint::frontend {

// Counts how much of the register files values take: 32-bit registers and predicates.
struct Pressure {
  int words = 0, predicates = 0;
  Pressure& operator+=(Pressure o) { return words += o.words, predicates += o.predicates, *this; }
  Pressure& operator-=(Pressure o) { return words -= o.words, predicates -= o.predicates, *this; }
  int sum() const { return words + predicates; }
};

inline Pressure pressure_of(RegisterClass c) {
  return {c == RegisterClass::B64   ? 2
          : c == RegisterClass::B32 ? 1
                                    : 0,
          c == RegisterClass::Predicate ? 1 : 0};
}
inline Pressure larger(Pressure a, Pressure b) {
  return {std::max(a.words, b.words), std::max(a.predicates, b.predicates)};
}
// Returns whether `growth` fits in addition to `now`. It always does where nothing grows.
inline bool fits(Pressure now, Pressure growth, Pressure limit) {
  return (growth.words <= 0 || now.words + growth.words <= limit.words) &&
         (growth.predicates <= 0 || now.predicates + growth.predicates <= limit.predicates);
}

}  // namespace glint::frontend
