// Tells what GLSL's float built-ins should give: the value in double precision, and the distance that Vulkan
// allows.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string_view>

#include "tests/shaders/bounded.h"

namespace glint::test {

// Holds the inputs of an expression of a, b and c. ua, ia and similar names are the bits of the same inputs
// as unsigned and signed integers.
struct Inputs {
  float a, b, c;
  uint32_t ua, ub, uc;
};
struct BuiltinReference {
  std::string_view expression;
  double (*value)(const Inputs&);
  Bounded (*bound)(const Inputs&);
  // Tells whether GLSL defines the result; null: for all numbers.
  bool (*is_defined)(const Inputs&) = nullptr;
  // The formula in single precision, for expressions that the driver contracts to an fma and Glint does not
  // (frontend/README.md).
  float (*in_order)(const Inputs&) = nullptr;
  // With true, Glint has the driver's bits, except where numbers are subnormal, or nearly.
  bool is_same_form = false;
};

// Returns the reference of an expression, or null.
const BuiltinReference* find_reference(std::string_view expression);

}  // namespace glint::test
