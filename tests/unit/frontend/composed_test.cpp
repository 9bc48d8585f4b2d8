// Compares GLSL's functions that are sums of products with their exact values, also where the sums cancel.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "tests/support/catch.h"
#include "tests/unit/frontend/shader_lab.h"

namespace glint::frontend {
namespace {

using Exact = long double;
constexpr size_t kNumbers = 16;
using Numbers = std::array<float, kNumbers>;

// Returns the bits of the numbers of a shader's invocation. In invocations with an odd x all numbers lie
// within 15 ulp of each other, so that differences cancel.
uint32_t number_bits(uint32_t x, uint32_t k) {
  const auto hash = [](uint32_t n) {
    n = (n ^ n >> 16) * 0x7feb352du;
    n = (n ^ n >> 15) * 0x846ca68bu;
    return n ^ n >> 16;
  };
  const uint32_t own = hash(x * 64 + k + 1), first = hash(x * 64 + 1);
  if (x & 1) return ((first & 0x007ffff0u) | 0x3f800000u) + (own >> 28);
  return (own & 0x807fffffu) | (124 + (own >> 23 & 7)) << 23;
}
const std::string kNumberInGlsl = R"(
uint hash(uint n) { n = (n ^ n >> 16) * 0x7feb352du; n = (n ^ n >> 15) * 0x846ca68bu; return n ^ n >> 16; }
float number(uint x, uint k) {
  uint own = hash(x * 64 + k + 1), first = hash(x * 64 + 1);
  return uintBitsToFloat((x & 1) != 0 ? (first & 0x007ffff0u | 0x3f800000u) + (own >> 28)
                                      : own & 0x807fffffu | (124 + (own >> 23 & 7)) << 23);
}
)";

Exact ulp(Exact x) {
  return std::ldexp(Exact(1), std::ilogb(x) - 23);
}

// Runs a function of n[0] to n[15] in 512 invocations.
std::vector<float> values_of(const std::string& function) {
  std::vector<uint32_t> xs(512);
  std::iota(xs.begin(), xs.end(), 0);
  std::vector<float> out;
  for (const uint32_t bits :
       lab::run(xs,
                "float n[16]; for (uint k = 0; k < 16; ++k) n[k] = number(x, k); y = floatBitsToUint(" +
                    function + ");",
                kNumberInGlsl))
    out.push_back(std::bit_cast<float>(bits));
  return out;
}
Numbers numbers_of(uint32_t x) {
  Numbers n;
  for (uint32_t k = 0; k < kNumbers; ++k) n[k] = std::bit_cast<float>(number_bits(x, k));
  return n;
}

// Holds an exact value and the sum of the magnitudes of the products that it consists of.
struct Sum {
  Exact value = 0, size = 0;
  Sum& add(Exact product) {
    value += product, size += std::abs(product);
    return *this;
  }
};

void check_within(double limit, const std::string& function,
                  const std::function<Sum(const Numbers&)>& exact) {
  const std::vector<float> got = values_of(function);
  INFO(function);
  double worst = 0;
  for (uint32_t x = 0; x < got.size(); ++x) {
    const Sum sum = exact(numbers_of(x));
    worst = std::max(worst, double(std::abs(Exact(got[x]) - sum.value) / ulp(sum.size)));
  }
  CHECK(worst <= limit);
  CHECK(worst > 0);
}

Sum determinant(const Numbers& n, size_t order, const std::vector<size_t>& rows,
                const std::vector<size_t>& columns) {
  if (rows.size() == 1) return Sum().add(n[columns[0] * order + rows[0]]);
  Sum out;
  for (size_t c = 0; c < columns.size(); ++c) {
    std::vector<size_t> rest = columns;
    rest.erase(rest.begin() + long(c));
    const Sum minor = determinant(n, order, {rows.begin() + 1, rows.end()}, rest);
    const Exact factor = (c % 2 ? -1 : 1) * Exact(n[columns[c] * order + rows[0]]);
    out.value += factor * minor.value, out.size += std::abs(factor) * minor.size;
  }
  return out;
}

}  // namespace

TEST_CASE(
    "functions that are sums of products err by little of their largest product, also where it cancels") {
  check_within(1, "mix(n[0], n[1], n[2])",
               [](const Numbers& n) { return Sum().add(n[0]).add((Exact(n[1]) - n[0]) * n[2]); });
  check_within(1, "cross(vec3(n[0], n[1], n[2]), vec3(n[3], n[4], n[5])).x",
               [](const Numbers& n) { return Sum().add(Exact(n[1]) * n[5]).add(-Exact(n[4]) * n[2]); });
  check_within(2, "reflect(vec2(n[0], n[1]), vec2(n[2], n[3])).y", [](const Numbers& n) {
    const Exact twice = 2 * Exact(n[3]);
    return Sum().add(n[1]).add(-twice * n[0] * n[2]).add(-twice * n[1] * n[3]);
  });
  check_within(1, "determinant(mat2(n[0], n[1], n[2], n[3]))", [](const Numbers& n) {
    return determinant(n, 2, {0, 1}, {0, 1});
  });
  check_within(2, "determinant(mat3(n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8]))",
               [](const Numbers& n) {
                 return determinant(n, 3, {0, 1, 2}, {0, 1, 2});
               });
  check_within(3,
               "determinant(mat4(n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8], n[9], n[10], n[11], "
               "n[12], n[13], n[14], n[15]))",
               [](const Numbers& n) {
                 return determinant(n, 4, {0, 1, 2, 3}, {0, 1, 2, 3});
               });
}

TEST_CASE("distances and directions err by at most two ulp, also between points close to each other") {
  const auto norm = [](const Numbers& n) {
    Exact sum = 0;
    for (size_t i = 0; i < 3; ++i) sum += (Exact(n[i]) - n[i + 3]) * (Exact(n[i]) - n[i + 3]);
    return std::sqrt(sum);
  };
  const std::vector<float> got = values_of("distance(vec3(n[0], n[1], n[2]), vec3(n[3], n[4], n[5]))"),
                           direction = values_of("normalize(vec3(n[0], n[1], n[2])).y");
  for (uint32_t x = 0; x < got.size(); ++x) {
    Numbers n = numbers_of(x);
    if (norm(n) != 0) CHECK(std::abs(got[x] - norm(n)) <= 2 * ulp(norm(n)));
    n[3] = n[4] = n[5] = 0;
    CHECK(std::abs(direction[x] - n[1] / norm(n)) <= 2 * ulp(n[1] / norm(n)));
  }
}

// The recordings of a driver have these bits in all lanes without NaN and subnormals (tests/shaders).
TEST_CASE("mix, cross and reflect have the bits of the forms that a driver uses") {
  const std::vector<float> mixed = values_of("mix(n[0], n[1], n[2])"),
                           crossed = values_of("cross(vec3(n[0], n[1], n[2]), vec3(n[3], n[4], n[5])).y"),
                           reflected = values_of("reflect(vec3(n[0], n[1], n[2]), vec3(n[3], n[4], n[5])).z");
  for (uint32_t x = 0; x < mixed.size(); ++x) {
    const Numbers n = numbers_of(x);
    CHECK(mixed[x] == std::fma(n[2], n[1] - n[0], n[0]));
    CHECK(crossed[x] == std::fma(n[2], n[3], -(n[5] * n[0])));
    const float along = std::fma(n[3], n[0], std::fma(n[4], n[1], n[5] * n[2]));
    CHECK(reflected[x] == std::fma(-2 * along, n[5], n[2]));
  }
}

// The exact value is 5156.4, and halves are 4 apart there. Halves at each step would give 5168.
TEST_CASE("a determinant of halves is the exact value rounded once") {
  const auto got = lab::run(
      {77},
      "f16mat4 m = f16mat4(float16_t(float(x) / 16.0), 9.75hf, -1.0625hf, 5.1875hf, 7.9375hf, 10.375hf, "
      "12.125hf, "
      "0.1875hf, -1.0625hf, -2.125hf, 4.9375hf, -7.4375hf, 8.375hf, 4.4375hf, -2.9375hf, -6.8125hf); "
      "y = floatBitsToUint(float(determinant(m)));",
      "#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require\n");
  CHECK(std::bit_cast<float>(got[0]) == 5156.0f);
}

}  // namespace glint::frontend
