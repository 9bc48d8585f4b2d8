// Finds names of ops by width, and computes narrow types in wider registers.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/lower/typed.h"

#include <cstdint>

namespace glint::frontend {
namespace {

bool gives_predicate(std::string_view name) {
  return name.starts_with("setp.") || name.starts_with("testp.");
}

bool has(const std::string& name) {
  return isa::find_op(name) >= 0;
}

}  // namespace

std::string with_bits(std::string_view name32, uint32_t bits) {
  std::string name(name32);
  for (size_t at = name.find("32"); at != std::string::npos; at = name.find("32", at + 2))
    name.replace(at, 2, std::to_string(bits));
  return name;
}

Operand widened(Emitter& e, Part part, const Operand& x, bool sign_extend) {
  const uint32_t bits = 8 * bytes_of(part);
  if (part == Part::Float16) return e.value("cvt.f32.f16", {x});
  if (bits >= 32 || part == Part::Bool || !sign_extend) return x;
  if (x.kind == Operand::Kind::Constant)
    return word(uint32_t(int32_t(uint32_t(x.constant) << (32 - bits)) >> (32 - bits)));
  return e.value("bfe.s32", {x, word(0), word(bits)});
}

Operand narrowed(Emitter& e, Part part, const Operand& x) {
  const uint32_t bits = 8 * bytes_of(part);
  if (part == Part::Float16) return e.value("cvt.rn.f16.f32", {x});
  if (bits >= 32 || part == Part::Bool) return x;
  return e.value("and.b32", {x, word((1u << bits) - 1)});
}

bool has_typed(std::string_view name32, Part part) {
  return bytes_of(part) == 8 ? has(with_bits(name32, 64)) : has(std::string(name32));
}

Operand typed(Emitter& e, std::string_view name32, Part part, const Operands& sources) {
  if (bytes_of(part) == 4) return e.value(name32, sources);
  if (bytes_of(part) == 8) return e.value(with_bits(name32, 64), sources);
  if (part == Part::Float16)
    if (const std::string name = with_bits(name32, 16); has(name)) return e.value(name, sources);
  const bool is_signed = name32.find(".s32") != std::string_view::npos;
  Operands wide;
  for (const Operand& source : sources) wide.push_back(widened(e, part, source, is_signed));
  const Operand result = e.value(name32, wide);
  return gives_predicate(name32) ? result : narrowed(e, part, result);
}

}  // namespace glint::frontend
