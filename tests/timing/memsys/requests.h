// Makes the requests of one line that tests of caches ask for.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "tests/support/memory_rig.h"

namespace glint::mem {

inline constexpr Address kLine = 128 * 1000;
inline constexpr Cycle kL2Hit = 160;  // from a request to its answer, where the L2 has the line

inline Request read(Address line, Token token, uint8_t sectors = 1) {
  return {line, sectors, false, Traffic::RtNode, token};
}
inline Request write(Address line, uint8_t sectors = 1, Traffic traffic = Traffic::ShaderGlobal,
                     WordMask words = kAllWords) {
  return {line, sectors, true, traffic, 0, words};
}

}  // namespace glint::mem
