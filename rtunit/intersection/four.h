// Holds four numbers that the host handles at a time, as every machine that the project runs on can.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <type_traits>

namespace glint::rt {

using Four = float __attribute__((vector_size(16)));
using FourBits = uint32_t __attribute__((vector_size(16)));

// Returns `x`, or four times `x`.
template <class T>
constexpr T all(float x) {
  if constexpr (std::is_same_v<T, float>)
    return x;
  else
    return T{x, x, x, x};
}

// Returns a bit for each part of a comparison's result that is true; the first is bit 0.
template <class Comparison>
inline uint32_t mask_of(Comparison holds) {
#if defined(__SSE__)
  return uint32_t(__builtin_ia32_movmskps(Four(holds)));
#else
  return uint32_t((holds[0] & 1) | (holds[1] & 2) | (holds[2] & 4) | (holds[3] & 8));
#endif
}

}  // namespace glint::rt
