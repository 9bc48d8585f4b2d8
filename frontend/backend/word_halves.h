// Reads words of pairs in place.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "frontend/backend/slots.h"

namespace glint::frontend {

// Lets the readers of a pair's low or high word read that half of the pair, so that nothing takes the word
// out. It does so for words all of whose readers can; a move cannot, because it gets the word's register.
void read_halves(VirtualProgram& program, const Ops& ops);

}  // namespace glint::frontend
