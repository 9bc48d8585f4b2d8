// Packs floats into words: normalised 8- and 16-bit integers, and half floats.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "frontend/lower/emitter.h"

namespace glint::frontend::pack {

// These functions are GLSL's packUnorm4x8 and its relatives. The argument is a vector to pack or a word to
// unpack. The first component lies in the lowest bits.
using Arguments = std::vector<Operands>;
Operands pack_unorm_4x8(Emitter& e, const Arguments& x);
Operands pack_snorm_4x8(Emitter& e, const Arguments& x);
Operands pack_unorm_2x16(Emitter& e, const Arguments& x);
Operands pack_snorm_2x16(Emitter& e, const Arguments& x);
Operands pack_half_2x16(Emitter& e, const Arguments& x);  // rounds to nearest even; NaN becomes 0x7fff
Operands unpack_unorm_4x8(Emitter& e, const Arguments& x);
Operands unpack_snorm_4x8(Emitter& e, const Arguments& x);
Operands unpack_unorm_2x16(Emitter& e, const Arguments& x);
Operands unpack_snorm_2x16(Emitter& e, const Arguments& x);
Operands unpack_half_2x16(Emitter& e, const Arguments& x);

}  // namespace glint::frontend::pack
