// Tests derivatives, AMD's instruction sets, atomics that become loops, wide constants, and functions that
// must not be inlined.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

#include "base/diagnostics.h"
#include "tests/shaders/compute_lab.h"
#include "tests/support/catch.h"

namespace glint::test::vendor_test {
namespace {

using Catch::Contains;

void each_machine(const ComputeLab& fresh, const std::function<void(ComputeLab&)>& check) {
  for (const LabOptions& options : compute_lab_options()) {
    INFO(to_string(options));
    ComputeLab lab = fresh;
    lab.run(options);
    check(lab);
  }
}

float real(uint32_t word) {
  return std::bit_cast<float>(word);
}

// Returns three levels of 4 x 4, 2 x 2 and one texel, with the values 1, 2 and 3.
LabImage levels() {
  LabImage image;
  image.view.format = exec::TexelFormat::R32Float;
  image.view.width = image.view.height = 4, image.view.levels = 3;
  image.view.sampler.mip = exec::Filter::Nearest;
  for (const auto& [count, value] : {std::pair{16, 1.0f}, {4, 2.0f}, {1, 3.0f}})
    image.texels.insert(image.texels.end(), size_t(count), std::bit_cast<uint32_t>(value));
  return image;
}

float field(uint32_t index) {
  const float x = float(index % 8), y = float(index / 8);
  return x * x + 100.0f * y * y + x * x * y * y;
}

// Checks derivatives. `right` and `below` are the bits that the neighbours' indices have and the index of the
// quad's first lane lacks.
void check_derivatives(const Words& results, uint32_t right, uint32_t below, float level, float biased) {
  for (uint32_t i = 0; i < 64; ++i) {
    INFO("thread " << i);
    const uint32_t* row = &results[8 * i];
    const auto along = [](uint32_t from, uint32_t step) {
      return field((from & ~step) | step) - field(from & ~step);
    };
    CHECK(real(row[0]) == along(i, right));
    CHECK(real(row[1]) == along(i, below));
    CHECK(real(row[2]) == std::abs(along(i, right)) + std::abs(along(i, below)));
    CHECK(real(row[3]) == along(i & ~below, right));
    CHECK(real(row[4]) == along(i & ~right, below));
    CHECK(real(row[5]) == -along(i, below));
    CHECK(real(row[6]) == level);
    CHECK(real(row[7]) == biased);
  }
}

TEST_CASE("derivatives are differences in quads of the block's coordinates, and choose levels of textures") {
  ComputeLab lab("compute/derivatives.comp");
  lab.buffers[0] = Words(64 * 8);
  lab.images[1] = {levels()};
  each_machine(lab, [](ComputeLab& after) { check_derivatives(after.buffers[0], 1, 8, 2.0f, 3.0f); });
}

TEST_CASE("derivatives are differences in quads of four threads in a row") {
  ComputeLab lab("compute/derivatives.comp");
  lab.glsl.defines = {{"LINEAR", "1"}};
  lab.buffers[0] = Words(64 * 8);
  lab.images[1] = {levels()};
  each_machine(lab, [](ComputeLab& after) { check_derivatives(after.buffers[0], 1, 2, 3.0f, 3.0f); });
}

Words mixed_values() {
  Words words;
  for (uint32_t state = 11; words.size() < 32;) {
    state = state * 747796405u + 2891336453u;
    words.push_back(uint32_t(int32_t(state >> 20) - 2000));
  }
  words[3] = words[10] = words[22] = 77;  // lane 3 sees the same number three times
  return words;
}

template <class T>
T middle(T a, T b, T c) {
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

// Returns face, s and t, case by case (Vulkan, "Cube Map Face Selection").
std::array<float, 3> cube(float x, float y, float z) {
  const float ax = std::abs(x), ay = std::abs(y), az = std::abs(z);
  if (az >= ax && az >= ay)
    return {z < 0 ? 5.0f : 4.0f, (z < 0 ? -x : x) / (2 * az) + 0.5f, -y / (2 * az) + 0.5f};
  if (ay >= ax) return {y < 0 ? 3.0f : 2.0f, x / (2 * ay) + 0.5f, (y < 0 ? -z : z) / (2 * ay) + 0.5f};
  return {x < 0 ? 1.0f : 0.0f, (x < 0 ? z : -z) / (2 * ax) + 0.5f, -y / (2 * ax) + 0.5f};
}

Words vendor_row(const Words& v, uint32_t self) {
  const auto at = [&](uint32_t lane) { return int32_t(v[lane & 31]); };
  const int32_t a = at(self), b = at(self + 7), c = at(self + 19);
  constexpr uint32_t kSwizzle[] = {3, 0, 1, 1};
  int32_t sum = 0, least = a, scanned = 0, most = INT32_MIN;
  for (uint32_t lane = 0; lane < 32; ++lane) {
    sum += at(lane), least = std::min(least, at(lane));
    if (at(lane) > 0) most = std::max(most, at(lane + 7));
    if (at(lane) > 0 && lane <= self) scanned += at(lane);
  }
  const auto bits = [](float f) { return std::bit_cast<uint32_t>(f); };
  const auto [face, s, t] = cube(float(a), float(b), float(c));
  const uint32_t below = 0x0f0f'1234u & ((1u << self) - 1);
  return {uint32_t(std::min({a, b, c})),
          uint32_t(std::max({a, b, c})),
          uint32_t(middle(a, b, c)),
          middle(uint32_t(a), uint32_t(b), uint32_t(c)),
          bits(middle(float(a), float(b), float(c))),
          uint32_t(at((self & ~3u) + kSwizzle[self & 3])),
          uint32_t(at(((self & 29) | 2) ^ 16)),
          uint32_t(self == 5 ? b : a),
          uint32_t(std::popcount(below)),
          uint32_t(sum),
          uint32_t(least),
          uint32_t(a > 0 ? most + scanned : 0),
          bits(face),
          bits(s),
          bits(t),
          1};
}

TEST_CASE("AMD's sets give minima of three, exchanges between lanes, and faces of cubes") {
  ComputeLab lab("compute/vendor.comp");
  lab.buffers[0] = Words(32 * 16);
  lab.buffers[1] = mixed_values();
  each_machine(lab, [](ComputeLab& after) {
    for (uint32_t lane = 0; lane < 32; ++lane) {
      const Words expected = vendor_row(after.buffers[1], lane);
      for (uint32_t word = 0; word < 16; ++word) {
        INFO("lane " << lane << " word " << word);
        CHECK(after.buffers[0][16 * lane + word] == expected[word]);
      }
    }
  });
}

TEST_CASE("atomics that the ISA lacks happen once for each thread") {
  ComputeLab lab("compute/atomic_loops.comp");
  lab.buffers[0] = {0xfc00'7c00, 0x3c00'fc00};  // infinity, -infinity, -infinity, 1 in half precision
  lab.buffers[1] = Words(64);
  LabImage picture{{}, {std::bit_cast<uint32_t>(-1000.0f), std::bit_cast<uint32_t>(1000.0f)}};
  picture.view.format = exec::TexelFormat::R32Float, picture.view.width = 2;
  lab.images[2] = {picture};
  each_machine(lab, [](ComputeLab& after) {
    CHECK(after.buffers[0][0] == 0x5160'cd00);  // 43 and -20
    CHECK(after.buffers[0][1] == 0x5020'4d60);  // 33, which thread 17 puts, and 21.5
    CHECK(real(after.buffers[1][0]) == -20.0f);
    CHECK(real(after.buffers[1][17]) == 1.0f);
    CHECK(real(after.images[2][0].texels[0]) == 43.0f);
    CHECK(real(after.images[2][0].texels[1]) == -20.0f);
  });
}

TEST_CASE("constants of 64 bits follow the values they are made of") {
  for (const bool is_set : {false, true}) {
    ComputeLab lab("compute/wide_constants.comp");
    if (is_set) lab.glsl.specialization = {{0, 0x1'0000'0000u}, {1, 5}, {2, std::bit_cast<uint64_t>(2.5)}};
    const uint64_t big = is_set ? 0x1'0000'0000u : 5000000000u;
    const int64_t small = is_set ? 5 : -3, product = small * 3000000000;
    lab.buffers[0] = Words(32 * 6);
    each_machine(lab, [&](ComputeLab& after) {
      for (uint32_t i = 0; i < 32; ++i) {
        INFO("thread " << i << ", values set: " << is_set);
        const auto at = [&](uint32_t n) {
          return after.buffers[0][6 * i + 2 * n] | uint64_t{after.buffers[0][6 * i + 2 * n + 1]} << 32;
        };
        CHECK(at(0) == (i % 2 == 0 ? big + 7 : (big >> 3) + big + 7));
        CHECK(at(1) == (i % 2 == 0 ? uint64_t(product) : is_set ? 20u : 6u));
        CHECK(at(2) == (product < 0 ? uint64_t(small) : big));
      }
    });
  }
}

TEST_CASE(
    "functions that ask not to be inlined run, also from a loop's continue construct; main is the entry "
    "point") {
  ComputeLab lab("compute/apart.spvasm");
  lab.buffers[0] = Words(32);
  each_machine(lab, [](ComputeLab& after) {
    for (uint32_t i = 0; i < 32; ++i) {
      uint32_t steps = 0;
      for (uint32_t x = i + 1; x != 1 && steps < 40; ++steps) x = (x & 1) != 0 ? 3 * x + 1 : x / 2;
      INFO("thread " << i);
      CHECK(after.buffers[0][i] == steps);
    }
  });
}

}  // namespace
}  // namespace glint::test::vendor_test
