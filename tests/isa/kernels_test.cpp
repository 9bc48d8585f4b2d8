// Tests the accuracy of the special functions against double precision, in units in the last place.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>

#include "isa/paths.h"
#include "tests/isa/warp_fixture.h"
#include "tests/support/catch.h"

using namespace glint;
using namespace glint::isa;

namespace {

// Returns the distance of `got` from `exact` in ulps of the float nearest to `exact`. Subnormals have the ulp
// 2^-149.
double error_ulps(float got, double exact) {
  int exponent = 0;
  std::frexp(exact, &exponent);
  return std::abs(double(got) - exact) / std::ldexp(1.0, std::max(exponent - 24, -149));
}

// Returns the largest error of `name` over `count` floats from `first` on, `step` bits apart, with both signs
// if asked.
template <class Exact>
double max_error(const char* name, uint32_t first, uint32_t last, uint32_t step, bool both_signs,
                 Exact exact) {
  const OpRow& row = op_table()[op_index(name)];
  WarpFixture w;
  const Inst inst = spread(row, op_index(name));
  w.warp.exec = kAllLanes;
  double worst = 0;
  for (uint64_t bits = first; bits < last; bits += uint64_t{step} * kLanes) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const uint32_t x = uint32_t(std::min<uint64_t>(bits + uint64_t(lane) * step, last));
      w.at(inst.operand[1], lane) = both_signs && lane % 2 ? x | 0x8000'0000u : x;
    }
    row.run(w.warp, inst, row);
    for (int lane = 0; lane < kLanes; ++lane) {
      const double x = double(std::bit_cast<float>(w.at(inst.operand[1], lane)));
      worst = std::max(worst, error_ulps(std::bit_cast<float>(w.at(inst.operand[0], lane)), exact(x)));
    }
  }
  return worst;
}

uint32_t bits(float x) {
  return std::bit_cast<uint32_t>(x);
}

}  // namespace

TEST_CASE("sine and cosine are within 0.51 ulp up to 1e5 and up to 2^48") {
  const auto sine = [](double x) { return std::sin(x); };
  const auto cosine = [](double x) { return std::cos(x); };
  CHECK(max_error("sin.f32", 1, bits(1e5f), 1499, true, sine) < 0.51);
  CHECK(max_error("cos.f32", 1, bits(1e5f), 1499, true, cosine) < 0.51);
  CHECK(max_error("sin.f32", bits(1e5f), bits(0x1p48f) - 1, 1499, true, sine) < 0.51);
  CHECK(max_error("cos.f32", bits(1e5f), bits(0x1p48f) - 1, 1499, true, cosine) < 0.51);
}

TEST_CASE("powers of two are within 0.51 ulp, gradual underflow included") {
  const auto power = [](double x) { return std::exp2(x); };
  CHECK(max_error("ex2.f32", 1, bits(127.99f), 1499, false, power) < 0.51);
  CHECK(max_error("ex2.f32", bits(-0.0f), bits(-149.0f), 1499, false, power) < 0.51);
}

TEST_CASE("logarithms are within 0.51 ulp, subnormals and the neighbourhood of 1 included") {
  const auto log = [](double x) { return std::log2(x); };
  CHECK(max_error("lg2.f32", 1, 0x7f7f'ffff, 1499, false, log) < 0.51);
  CHECK(max_error("lg2.f32", bits(0.99f), bits(1.01f), 7, false, log) < 0.51);
}

TEST_CASE("reciprocal square roots are within 0.51 ulp, reciprocals and roots are rounded correctly") {
  CHECK(max_error("rsqrt.f32", 1, 0x7f7f'ffff, 1499, false, [](double x) { return 1 / std::sqrt(x); }) <
        0.51);
  CHECK(max_error("sqrt.rn.f32", 1, 0x7f7f'ffff, 1499, false, [](double x) { return std::sqrt(x); }) <= 0.5);
  CHECK(max_error("rcp.rn.f32", bits(0x1p-127f), 0x7f7f'ffff, 1499, true, [](double x) { return 1 / x; }) <=
        0.5);
}
