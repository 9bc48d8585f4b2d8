// Emits ops for any type of numbers from the names of their 32-bit forms.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "frontend/lower/emitter.h"
#include "frontend/lower/layout.h"

namespace glint::frontend {

// Returns an op's name for another width: "add.rn.f32" becomes "add.rn.f64" for 64 bits. Every 32 in the name
// changes.
std::string with_bits(std::string_view name32, uint32_t bits);

// Returns a narrow value as 32 bits: floats are converted exactly, and integers get copies of their sign or
// zeros above. Wider values stay as they are.
Operand widened(Emitter& e, Part part, const Operand& x, bool sign_extend);
// Reverses widened(): floats are rounded to nearest even, and integers are cut.
Operand narrowed(Emitter& e, Part part, const Operand& x);

// Emits the op on operands of type `part`. Its name says whether integers are signed ("min.s32"). A narrow
// type uses the op of its own width if there is one, and otherwise the op of 32 bits. The result has the same
// type, or is a predicate.
Operand typed(Emitter& e, std::string_view name32, Part part, const Operands& sources);
// Returns whether there is such an op.
bool has_typed(std::string_view name32, Part part);

// Emits arithmetic in single or double precision, from which the elementary functions are built.
class Arithmetic {
 public:
  Arithmetic(Emitter& e, bool is_double) : e_(e), is_double_(is_double) {}

  Emitter& emit() { return e_; }
  bool is_double() const { return is_double_; }
  Operand constant(double value) const {
    return is_double_ ? Operand::value(std::bit_cast<uint64_t>(value)) : constant_f32(float(value));
  }
  Operand op(std::string_view name32, Operands sources) {
    return is_double_ ? e_.value(with_bits(name32, 64), std::move(sources))
                      : e_.value(name32, std::move(sources));
  }
  Operand add(Operand a, Operand b) { return op("add.rn.f32", {a, b}); }
  Operand sub(Operand a, Operand b) { return op("sub.rn.f32", {a, b}); }
  Operand mul(Operand a, Operand b) { return op("mul.rn.f32", {a, b}); }
  Operand div(Operand a, Operand b) { return op("div.rn.f32", {a, b}); }
  Operand fma(Operand a, Operand b, Operand c) { return op("fma.rn.f32", {a, b, c}); }
  Operand min(Operand a, Operand b) { return op("min.f32", {a, b}); }
  Operand max(Operand a, Operand b) { return op("max.f32", {a, b}); }
  Operand sqrt(Operand a) { return op("sqrt.rn.f32", {a}); }
  Operand negative(Operand a) { return op("neg.f32", {a}); }
  Operand magnitude(Operand a) { return op("abs.f32", {a}); }
  Operand with_sign(Operand magnitude, Operand sign) { return op("copysign.f32", {sign, magnitude}); }
  Operand less(Operand a, Operand b) { return op("setp.lt.f32", {a, b}); }
  Operand greater(Operand a, Operand b) { return op("setp.gt.f32", {a, b}); }
  Operand select(Operand predicate, Operand a, Operand b) { return op("selp.b32", {a, b, predicate}); }

 private:
  Emitter& e_;
  bool is_double_;
};

}  // namespace glint::frontend
