// Tests values that no code wrote: variables without a value, indices out of range, constants folded
// elsewhere.
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.h"
#include "tests/unit/frontend/shader_lab.h"
#include "tests/unit/frontend/value_table.h"

namespace glint::frontend::lab {
namespace {

TEST_CASE("variables that were never set are 0, on every path") {
  const std::string unset =
      "uint some(uint x) { uint v; if (x == 1u) v = 5u; return v; }\n"
      "float looped(uint x) { vec3 v; for (uint n = 0u; n < x; ++n) v.y += 2.0; return v.x + v.y; }\n"
      "bool flag(uint x) { bool b; if (x > 1u) b = true; return b; }\nstruct S { uint m; uvec2 n; }; uint "
      "member(uint x) { S s; if (x == 1u) s.m = 3u; return s.m + s.n.y; }\n";
  check_cases("some(A)", {{0, 0, 0, 0}, {1, 0, 0, 5}, {2, 0, 0, 0}}, unset);
  check_cases("looped(A)", {{0, 0, 0, 0}, {3, 0, 0, f(6)}}, unset);
  check_cases("flag(A)", {{0, 0, 0, 0}, {2, 0, 0, 1}}, unset);
  check_cases("member(A)", {{0, 0, 0, 0}, {1, 0, 0, 3}}, unset);
}

TEST_CASE("an index out of range of a vector that is a value gives its first component") {
  check_cases("(uvec3(A, B, C) + 1u)[A]",
              {{0, 7, 9, 1}, {1, 7, 9, 8}, {2, 7, 9, 10}, {3, 7, 9, 4}, {kOnes, 7, 9, 0}});
}

TEST_CASE("constant expressions are folded by the GLSL compiler, in double precision") {
  CHECK(run_f32({1.0f}, "f * (16777216.0 + 1.0 - 16777216.0)")[0] == 1.0f);
  check_cases("(a + b) - a", {{f(16777216), f(1), 0, 0}});
}

TEST_CASE(
    "integer operations on specialisation constants are folded by SPIRV-Tools, to 0 where they are "
    "undefined") {
  const std::string constants =
      "layout(constant_id = 900) const uint ZERO = 0u;\nlayout(constant_id = 901) const uint MANY = "
      "40u;\nlayout(constant_id = 902) const int MINUS = -8;\n";
  check_cases("7u / ZERO", {{0, 0, 0, 0}}, constants);
  check_cases("7u % ZERO", {{0, 0, 0, 0}}, constants);
  check_cases("1u << MANY", {{0, 0, 0, 0}}, constants);
  check_cases("MINUS >> MANY", {{0, 0, 0, 0}}, constants);
  check_cases("MINUS >> 1", {{0, 0, 0, uint32_t(-4)}}, constants);
}

}  // namespace
}  // namespace glint::frontend::lab
