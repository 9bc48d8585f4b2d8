// What GLSL's float built-ins should give: the value in double precision, and how far from it Vulkan lets one
// be. SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>

#include "tests/shaders/bounded.h"

namespace glint::test {

// One expression of a, b and c. ua, ia and their kin are the bits of the same inputs, as unsigned and signed
// integers.
struct Inputs {
  float a, b, c;
  uint32_t ua, ub, uc;
};
struct BuiltinReference {
  std::string_view expression;
  double (*value)(const Inputs&);
  Bounded (*bound)(const Inputs&);
  // Whether GLSL defines the result; null: for all numbers.
  bool (*is_defined)(const Inputs&) = nullptr;
  // The formula in single precision, where the driver contracts it to an fma and Glint does not
  // (frontend/README.md).
  float (*in_order)(const Inputs&) = nullptr;
};

// The reference of an expression, or null.
const BuiltinReference* find_reference(std::string_view expression);

}  // namespace glint::test
