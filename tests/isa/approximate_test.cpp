// Tests the special-function unit against hashes of recorded outputs, and its forms against each other.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "tests/isa/warp_fixture.h"
#include "tests/support/catch.h"

using namespace glint;
using namespace glint::isa;

namespace {

// Runs one op, a warp at a time.
class Runner {
 public:
  explicit Runner(std::string_view name)
      : row_(op_table()[op_index(name)]), inst_(spread(row_, op_index(name))) {
    fixture_.warp.exec = kAllLanes;
  }
  // Returns the results for inputs a(lane) and, where the op has two sources, b(lane).
  template <class A, class B>
  const uint32_t* run(A&& a, B&& b) {
    for (int lane = 0; lane < kLanes; ++lane) {
      fixture_.at(inst_.operand[1], lane) = a(uint32_t(lane));
      if (row_.operands.count > 2) fixture_.at(inst_.operand[2], lane) = b(uint32_t(lane));
    }
    row_.run(fixture_.warp, inst_, row_);
    return &fixture_.at(inst_.operand[0], 0);
  }
  template <class A>
  const uint32_t* run(A&& a) {
    return run(a, [](uint32_t) { return 0u; });
  }

 private:
  const OpRow& row_;
  Inst inst_;
  WarpFixture fixture_;
};

// Holds what a GPU (sm_90) answered to the inputs first, first + step, ...: a hash of all outputs, word by
// word.
struct Octave {
  std::string_view op;
  uint32_t first, step, count;
  uint64_t hash;
};
constexpr uint32_t kAll = 1u << 23, kSampled = 1u << 22;
constexpr Octave kOctaves[] = {
    {"rcp.approx.ftz.f32", 0x3f80'0000, 1, kAll, 0xfa72'a6c6'9827'4964},
    {"rsqrt.approx.ftz.f32", 0x3f00'0000, 1, kAll, 0x82b5'f6e1'5475'548b},
    {"rsqrt.approx.ftz.f32", 0x3f80'0000, 1, kAll, 0x0c40'b0bd'f554'807c},
    {"sqrt.approx.ftz.f32", 0x3f00'0000, 1, kAll, 0xa44a'5814'a119'6274},
    {"sqrt.approx.ftz.f32", 0x3f80'0000, 1, kAll, 0xec16'2b03'dcc3'9119},
    {"ex2.approx.ftz.f32", 0x3f80'0000, 1, kAll, 0x3f0f'3852'f2fa'7edb},
    {"lg2.approx.ftz.f32", 0x3f00'0000, 1, kAll, 0xf888'4f09'7b12'e53d},
    {"lg2.approx.ftz.f32", 0x3f80'0000, 1, kAll, 0x5ca4'3d6b'0d17'6848},
    {"sin.approx.ftz.f32", 0x3f80'0000, 1, kAll, 0xffc8'9f2c'26d5'96ea},
    {"sin.approx.ftz.f32", 0x4000'0000, 1, kAll, 0x5c6b'19fd'65ee'cc06},
    {"sin.approx.ftz.f32", 0x4080'0000, 1, kAll, 0xdb56'c449'555a'1951},
    {"cos.approx.ftz.f32", 0x4080'0000, 1, kAll, 0x5e2e'85d8'4cc9'39d6},
    {"tanh.approx.f32", 0x3e00'0000, 1, kAll, 0x4ada'670d'afb6'c6e5},
    {"tanh.approx.f32", 0x3e80'0000, 1, kAll, 0x0bf2'ef9f'6a7f'5765},
    {"tanh.approx.f32", 0x3f00'0000, 1, kAll, 0xecb8'e846'da55'4505},
    // The inputs go from 2^-31 to more than 2^19.
    {"ex2.approx.ftz.f32", 0x3000'0000, 127, kSampled, 0x2543'392f'3359'd1f9},
    {"ex2.approx.ftz.f32", 0xb000'0000, 127, kSampled, 0x9525'b416'35b9'14c4},
    {"sin.approx.ftz.f32", 0x3000'0000, 127, kSampled, 0x1db0'2881'7305'76d9},
    {"tanh.approx.f32", 0x3000'0000, 101, kSampled, 0x9fd3'8fd0'4d5f'722d},
};

uint64_t hash_of(const Octave& octave) {
  Runner op(octave.op);
  uint64_t hash = 0xcbf2'9ce4'8422'2325ull;  // FNV-1a, with words in place of bytes
  for (uint32_t i = 0; i < octave.count; i += kLanes) {
    const uint32_t* const out =
        op.run([&](uint32_t lane) { return octave.first + (i + lane) * octave.step; });
    for (int lane = 0; lane < kLanes; ++lane) hash = (hash ^ out[lane]) * 0x100'0000'01b3ull;
  }
  return hash;
}

float as_float(uint32_t bits) {
  float x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

// Returns floats of all signs and exponents. An odd factor spreads the mantissas.
uint32_t sample(uint32_t i) {
  return i * 0x9e37'79b9u;
}

}  // namespace

TEST_CASE("each function of the unit gives the recorded bits for all mantissas") {
  for (const Octave& octave : kOctaves) {
    INFO(octave.op << " from " << octave.first);
    CHECK(hash_of(octave) == octave.hash);
  }
}

TEST_CASE("without .ftz the unit's functions change only where an argument or a result is subnormal") {
  constexpr std::array<std::string_view, 2> kPairs[] = {{"rcp.approx.ftz.f32", "rcp.approx.f32"},
                                                        {"rsqrt.approx.ftz.f32", "rsqrt.approx.f32"},
                                                        {"sqrt.approx.ftz.f32", "sqrt.approx.f32"},
                                                        {"lg2.approx.ftz.f32", "lg2.approx.f32"},
                                                        {"ex2.approx.ftz.f32", "ex2.approx.f32"}};
  for (const auto& pair : kPairs) {
    Runner with(pair[0]), without(pair[1]);
    int different = 0, compared = 0;
    for (uint32_t i = 0; i < 1u << 18; i += kLanes) {
      const uint32_t* const a = with.run([&](uint32_t lane) { return sample(i + lane); });
      const uint32_t* const b = without.run([&](uint32_t lane) { return sample(i + lane); });
      for (uint32_t lane = 0; lane < kLanes; ++lane) {
        const float x = as_float(sample(i + lane)), y = as_float(b[lane]);
        if (std::fpclassify(x) == FP_SUBNORMAL || std::fpclassify(y) == FP_SUBNORMAL) continue;
        ++compared;
        different += a[lane] != b[lane];
      }
    }
    INFO(pair[0]);
    CHECK(different == 0);
    CHECK(compared > 200'000);
  }
}

TEST_CASE("a bfloat's result is the upper half of the float's, for every bfloat") {
  constexpr std::string_view kForms[][2] = {{"ex2.approx.ftz.bf16", "ex2.approx.ftz.f32"},
                                            {"tanh.approx.bf16", "tanh.approx.f32"}};
  for (const auto& form : kForms) {
    Runner narrow(form[0]), wide(form[1]);
    int different = 0;
    for (uint32_t i = 0; i < 0x1'0000; i += kLanes) {
      const uint32_t* const a = narrow.run([&](uint32_t lane) { return 0xdead'0000u | (i + lane); });
      const uint32_t* const b = wide.run([&](uint32_t lane) { return (i + lane) << 16; });
      for (int lane = 0; lane < kLanes; ++lane) different += a[lane] != b[lane] >> 16;
    }
    INFO(form[0]);
    CHECK(different == 0);
  }
}

TEST_CASE("a pair's halves are what the single form gives, for every half and bfloat") {
  constexpr std::string_view kForms[][2] = {{"ex2.approx.f16", "ex2.approx.f16x2"},
                                            {"tanh.approx.f16", "tanh.approx.f16x2"},
                                            {"ex2.approx.ftz.bf16", "ex2.approx.ftz.bf16x2"},
                                            {"tanh.approx.bf16", "tanh.approx.bf16x2"}};
  for (const auto& form : kForms) {
    Runner single(form[0]), other(form[0]), pair(form[1]);
    int different = 0;
    for (uint32_t i = 0; i < 0x1'0000; i += kLanes) {
      const auto low = [&](uint32_t lane) { return i + lane; };
      const auto high = [&](uint32_t lane) { return (i + lane) * 0x6d2bu & 0xffffu; };
      const uint32_t* const a = single.run(low);
      const uint32_t* const b = other.run(high);
      const uint32_t* const both = pair.run([&](uint32_t lane) { return low(lane) | high(lane) << 16; });
      for (int lane = 0; lane < kLanes; ++lane) different += both[lane] != (a[lane] | b[lane] << 16);
    }
    INFO(form[1]);
    CHECK(different == 0);
  }
}

TEST_CASE("div.full is within 2 ulp wherever the quotient is normal, div.approx also while |b| <= 2^126") {
  for (const std::string_view name : {"div.full.f32", "div.approx.f32"}) {
    Runner op(name);
    double worst = 0;
    for (uint32_t i = 0; i < 1u << 18; i += kLanes) {
      const auto b = [&](uint32_t lane) { return sample((i + lane) * 7 + 3); };
      const uint32_t* const out = op.run([&](uint32_t lane) { return sample(i + lane); }, b);
      for (uint32_t lane = 0; lane < kLanes; ++lane) {
        const double x = as_float(sample(i + lane)), y = as_float(b(lane)), exact = x / y;
        if (!(std::fabs(exact) > 0x1p-125 && std::fabs(exact) < 0x1p127)) continue;
        if (name == "div.approx.f32" && (std::fabs(y) > 0x1p126 || std::fabs(y) < 0x1p-126)) continue;
        const double ulp = std::ldexp(1.0, std::ilogb(exact) - 23);
        worst = std::fmax(worst, std::fabs(as_float(out[lane]) - exact) / ulp);
      }
    }
    INFO(name);
    CHECK(worst <= 2.0);
    CHECK(worst > 0.5);  // an exact quotient would not be the unit's
  }
}
