// Says how many of a word's low bits may be other than 0.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "frontend/backend/def_use.h"

namespace glint::frontend::ptx {

// Follows registers with one definition to the operations that leave high bits 0. Whatever turn of a loop a
// value is of, the bound holds for it.
class KnownBits {
 public:
  explicit KnownBits(const DefUse& registers) : registers_(registers) {}

  // Returns the number of low bits outside of which the word is 0.
  unsigned width(const VirtualOperand& o, int depth = 0) const {
    constexpr int kDeepest = 10;
    if (is_constant(o)) return unsigned(std::bit_width(uint32_t(o.constant)));
    const VirtualInst* source = depth < kDeepest ? registers_.definition(o) : nullptr;
    if (!source || !is_real(*source)) return 32;
    const auto of = [&](size_t k) { return width(source->operands[k], depth + 1); };
    const std::string_view name = row_of(*source).name;
    if (name.starts_with("ld.") && !name.ends_with(".s8") && !name.ends_with(".s16"))
      return name.ends_with("8") ? 8 : name.ends_with("16") ? 16 : 32;
    if (name == "and.b32" || name == "and.b16" || name == "min.u32") return std::min(of(1), of(2));
    if (name == "or.b32" || name == "xor.b32" || name == "selp.b32" || name == "max.u32")
      return std::max(of(1), of(2));
    if (name == "mov.b32") return of(1);
    if (name == "add.u32" || name == "add.s32") return std::min(32u, std::max(of(1), of(2)) + 1);
    if (name == "mul.lo.u32" || name == "mul.lo.s32") return std::min(32u, of(1) + of(2));
    if (name == "cvt.u32.u8") return 8;
    if (name == "cvt.u32.u16" || name == "cvt.u16.u32") return std::min(16u, of(1));
    if (name == "popc.b32") return 6;
    if (name == "prmt.b32" && is_constant(source->operands[2]) && source->operands[2].constant == 0 &&
        is_constant(source->operands[3]))
      return picked_width(uint32_t(source->operands[3].constant));
    if (is_constant(source->operands.back()) && source->operands.size() == 3) {
      const auto places = unsigned(std::min<uint64_t>(uint32_t(source->operands[2].constant), 32));
      if (name == "shr.u32" || name == "shr.b32") return of(1) - std::min(of(1), places);
      if (name == "shl.b32") return of(1) == 0 ? 0 : std::min(32u, of(1) + places);
    }
    return writes_short(name) ? 16 : 32;
  }

 private:
  // Returns the bits below the high bytes that `prmt` takes from a second source of zeros.
  static unsigned picked_width(uint32_t selector) {
    unsigned bytes = 4;
    while (bytes > 0 && (selector >> (4 * (bytes - 1)) & 0xc) == 4) --bytes;
    return 8 * bytes;
  }
  // Returns true for arithmetic of 16 bits, which leaves the upper half of a register 0 (isa/op_makers.h).
  static bool writes_short(std::string_view name) {
    if (!name.ends_with(".u16") && !name.ends_with(".s16") && !name.ends_with(".b16")) return false;
    for (const std::string_view op :
         {"add.", "sub.", "mul.lo.", "mad.lo.", "min.", "max.", "or.", "xor.", "not.", "shl.", "shr."})
      if (name.starts_with(op) && name.size() == op.size() + 3) return true;
    return false;
  }

  const DefUse& registers_;
};

}  // namespace glint::frontend::ptx
