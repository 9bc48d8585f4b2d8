// Tests the language without rays: control flow, memory layouts, arrays, constants and images, lane by lane.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>

#include "tests/shaders/lane_checks.h"
#include "tests/support/catch.h"

namespace glint::test {
namespace {

bool search(uint32_t start, uint32_t& steps, uint32_t& found) {
  found = 77;
  for (uint32_t i = start; i < 20; ++i) {
    if (i % 7 == 3) continue;
    for (uint32_t j = 0;; ++j) {
      ++steps;
      if (j > i) break;
      if (i * j == 30) return found = i * 100 + j, true;
      if ((i + j) % 5 == 4) continue;
      steps += 10;
    }
    if (steps > 400) return false;
  }
  found = 5;
  return false;
}

uint32_t classify(uint32_t x) {
  switch (x) {
    case 0:
      return 11;
    case 1:
      return 10;
    case 2:
      return 6000;
    case 3:
    case 4:
      return 42;
    case 5:
      return 6102;
    case 7:
      return 1100;
    default:
      return 6100;
  }
}

uint32_t loop_with_switch(uint32_t x) {
  uint32_t sum = 0;
  for (int i = 0; i < 10; ++i) {
    const uint32_t label = (x + uint32_t(i)) & 3;
    if (label == 0) continue;
    if (label == 1) sum += 1;
    if (label == 2) {
      if (i > 6) return sum + 1000;
      sum += 10;
    }
    if (label == 3) do {
        sum += 100;
        if (sum > 350) break;
      } while ((sum / 100) % 3 != 0);
    if (sum > 900) break;
    sum += 1u << 12;
  }
  return sum;
}

uint32_t short_circuits(uint32_t lane) {
  uint32_t calls = 0;
  const auto touch = [&](bool value) { return ++calls, value; };
  const bool a = (touch(lane & 1) && touch(lane & 2)) || touch(lane & 4);
  const bool b = lane & 8 ? touch(a) : !touch(true) || touch(false);
  return calls | (a ? 0x100 : 0) | (b ? 0x200 : 0);
}

Row control(uint32_t lane) {
  Row row(8, 0);
  uint32_t steps = lane, found = 0;
  row[0] = uint32_t(search(lane % 11, steps, found));
  row[0] |= steps << 1;
  row[1] = found;
  row[2] = classify(lane % 9);
  row[3] = loop_with_switch(lane);
  row[4] = short_circuits(lane);
  uint32_t n = lane, count = 0;
  do {
    if (n == 1) break;
    n = n & 1 ? 3 * n + 1 : n / 2;
    if (++count == 30) {
      count += 1000;
      break;
    }
  } while (n > 0);
  row[5] = count;
  if (lane > 40) return row[6] = 1, row;
  for (uint32_t k = 0;;) {
    row[6] = k += lane + 1;
    if (k < 20) continue;
    if (k % 3 == 0) break;
    if (k > 100) return row[7] = 9, row;
  }
  uint32_t trail[4] = {}, i = lane & 3;
  const uint32_t first = i++;
  trail[first] = i;
  const uint32_t second = i++ & 3;
  trail[second] += i * 10;
  row[7] = trail[0] | trail[1] << 8 | trail[2] << 16 | trail[3] << 24;
  return row;
}

TEST_CASE("loops, switches, early returns and short circuits take each lane where it wants to go") {
  RayLab lab({"control.rgen", {}, {}, {}});
  check_lanes(lab, control);
}

// Returns the words of a buffer of floats in which word i is 1 + i.
std::vector<uint32_t> counting(uint32_t words) {
  std::vector<uint32_t> result;
  for (uint32_t i = 0; i < words; ++i) result.push_back(bits(float(i + 1)));
  return result;
}

// Gives m[column][row] of a matrix whose words count from `first`, with `stride` words from one column (or
// row) to the next.
struct MatrixWords {
  uint32_t first, stride;
  bool by_rows;
  float at(uint32_t column, uint32_t row) const {
    return float(first + 1 + (by_rows ? row * stride + column : column * stride + row));
  }
};

Row matrices(uint32_t lane) {
  const uint32_t i = lane & 3;
  const MatrixWords rows{0, 4, true}, columns{0, 4, false}, affine_rows{16, 4, true},
      affine_columns{16, 4, false};
  // mat2x3 has 2 columns of 3 rows. In row-major std430 it has 3 rows of 8 bytes, and in column-major std140
  // it has 2 columns of 16.
  const auto small_rows = [](uint32_t k) { return MatrixWords{28 + 6 * k, 2, true}; };
  const auto small_columns = [](uint32_t k) { return MatrixWords{32 + 8 * k, 4, false}; };
  const float v[4] = {1, 2, 3, float(i)}, weight[4] = {1, 10, 100, 1000};
  Row row;
  for (const MatrixWords& m : {rows, columns}) {
    float sum = 0;
    for (uint32_t r = 0; r < 4; ++r) {
      float part = 0;
      for (uint32_t c = 0; c < 4; ++c) part += m.at(c, r) * v[c];
      sum += part * weight[r];
    }
    row.push_back(bits(sum));
  }
  row.push_back(bits(rows.at(i, 3 - i)));
  row.push_back(bits(columns.at(i, 3 - i)));
  float p[3] = {};
  for (uint32_t r = 0; r < 3; ++r)
    for (uint32_t c = 0; c < 4; ++c) p[r] += affine_rows.at(c, r) * v[c];
  row.push_back(bits(p[0] + 100 * p[1] + 10000 * p[2]));
  row.push_back(bits(affine_columns.at(i, 2) + affine_rows.at(i, 1) * 100));
  row.push_back(bits(small_rows(i % 3).at(1, 2) + 100 * small_columns(i % 3).at(1, 2)));
  row.push_back(bits(small_rows(2).at(i & 1, i % 3) + 100 * small_columns(2).at(i & 1, i % 3)));
  // The scalar layout is: head, then frames of 9 + 3 + 1 + 2 * 6 = 25 words, then tail, written,
  // written_rows.
  const auto frame = [](uint32_t f) { return 1 + 25 * f; };
  const uint32_t f = frame(i & 1);
  row.push_back(
      bits(MatrixWords{f, 3, false}.at(2, 1) + float(f + 9 + 2 + 1) * 100 + float(f + 12 + 1) * 10000));
  row.push_back(bits(MatrixWords{f + 13 + 6, 3, false}.at(1, 2) +
                     MatrixWords{frame(1) + 13 + 6 * (i & 1), 3, false}.at(0, i % 3) * 100));
  row.push_back(bits(MatrixWords{51, 3, true}.at(i % 3, 1)));
  const auto look = [&](uint32_t c, uint32_t r) {
    return (c == i ? 9.0f : rows.at(c, r)) + (c == 1 && r == i ? 1.0f : 0.0f);
  };
  row.push_back(bits(look(i, 0) + look(1, i) * 100 + look(2, 2) * 10000));
  float s[3][3];
  for (uint32_t c = 0; c < 3; ++c)
    for (uint32_t r = 0; r < 3; ++r) s[c][r] = rows.at(c, r) * (c == i % 3 ? 2 : 1);
  s[2][0] = s[0][1], s[2][1] = s[0][0];
  float total = 0;
  for (int r = 0; r < 3; ++r) total += s[0][r] + 10 * s[1][r] + 100 * s[2][r];
  row.push_back(bits(total));
  float product = 0, left = 0;
  for (uint32_t k = 0; k < 4; ++k) product += columns.at(1, k) * rows.at(i, k), left += v[k] * rows.at(i, k);
  row.push_back(bits(product));
  row.push_back(bits(left));
  row.push_back(bits(float((i % 3 + 2 + (i & 1)) * (i + 1))));
  row.push_back(bits(1.25f + 5.0f));
  return row;
}

TEST_CASE("matrices in buffers are read and written by majorness, stride and layout rule") {
  RayLab lab({"matrices.rgen", {}, {}, {}});
  lab.words_per_lane = 24;
  for (uint32_t binding : {10u, 11u, 12u}) lab.buffers[binding] = counting(80);
  check_lanes(lab, matrices);
  const std::vector<uint32_t>& mixed = lab.buffers_after[12];
  const auto at = [&](uint32_t word) { return std::bit_cast<float>(mixed[word]); };
  CHECK((at(60) == 1 && at(65) == 60 && at(68) == 9));                                 // columns of three
  CHECK((at(69) == 1 && at(70) == 3 && at(71) == 50 && at(72) == 2 && at(74) == 60));  // two rows of three
  CHECK(at(1 + 13 + 1) == 12345);
  CHECK(at(75) == 76);
}

Row layouts(uint32_t lane) {
  const uint32_t one = lane & 1;
  const auto f = [](uint32_t word) { return float(word + 1); };
  // The words are in std140: weights at 0 with 3 x 4 words; outer at 12 with head, inner at +4 of 8 words
  // each, tail at +20 and last at +23; flag at 36; pairs at 40 of 4 words each. In std430: count at 0; outers
  // at 4 of 24 words each, with head at 0, inner at 4 and 12, tail at 20 and last at 23. In scalar layout:
  // count at 0, normal at 1, inner at 4 of 6 words each.
  Row row;
  row.push_back(bits(f(4 * (lane % 3)) + f(12)));
  row.push_back(bits(f(16 + 8 * one + 3) + f(24 + 5) * 100));
  row.push_back(bits(f(12 + 22)));
  row.push_back(bits(f(45)));
  row.push_back(3 | 4 << 8 | 5 << 16);
  row.push_back(bits(f(4 + 24 * one + 12 + 2) + f(4 + 24 + 4 + 8 * one + 4)));
  row.push_back(bits(f(4 + 24 + 23)));
  row.push_back(bits(f(4 + 20 + lane % 3)));
  row.push_back(bits(f(4 + 6 * one + 1) + f(4 + 6 * one + 4) * 100 + f(3)));
  row.push_back(bits(f(2 * one + 1)));
  row.push_back(bits(f(9 * one + lane % 9)));
  row.push_back(bits(f(4 + 2) + f(12 + lane % 3) + f(10) * 100));
  row.push_back(bits(f(7)));
  const float other = f(4 + 24 + 4 + 8 * (1 - one) + (one ? 0 : 1));
  row.push_back(bits(one ? other + float(lane) : float(lane) + other));
  return row;
}

TEST_CASE(
    "uniform, storage, scalar and push-constant blocks have their members where their layout rule says") {
  RayLab lab({"layouts.rgen", {}, {}, {}});
  lab.words_per_lane = 16;
  lab.buffers[10] = counting(48);
  lab.buffers[11] = counting(4 + 3 * 24);
  lab.buffers[13] = counting(18);
  lab.set1[5] = counting(10);
  lab.push_constants = counting(16);
  lab.buffers[12] = counting(4 + 4 * 6);
  // Lane 3 writes inner[1] while other lanes read it, so the readers' words are kept as they are.
  RayLab& l = lab;
  for (const LabOptions& options : all_lab_options()) {
    INFO(to_string(options));
    const std::vector<uint32_t> got = l.run(options);
    for (uint32_t lane = 0; lane < 32; ++lane) {  // the first warp reads before lane 3 writes
      const Row row = layouts(lane);
      for (size_t i = 0; i < row.size(); ++i) {
        INFO("lane " << lane << " word " << i << " as float " << std::bit_cast<float>(got[lane * 16 + i]));
        CHECK(got[lane * 16 + i] == row[i]);
      }
    }
    CHECK(l.buffers_after[12][10] == bits(5));
    CHECK(l.buffers_after[12][13] == bits(6));
    CHECK(l.buffers_after[12][15] == bits(8));
    CHECK(l.buffers_after[12][16] == bits(17));
    CHECK(l.buffers_after[12][2] == bits(-1));
  }
}

Row arrays(uint32_t lane) {
  const uint32_t i = lane % 3, q4 = lane & 3;
  const float poisson[4][2] = {{0.1f, 0.2f}, {0.3f, 0.4f}, {0.5f, 0.6f}, {0.7f, 0.8f}};
  Row row;
  row.push_back(bits(poisson[q4][1] + poisson[i][0]));
  row.push_back(1 + 3 * (lane & 1) + i);
  float values[4] = {1, 2, 3, 4}, sum = 0;
  values[q4] = 10;
  for (uint32_t k = 0; k <= q4; ++k) sum += values[k];
  row.push_back(bits(sum + values[0]));
  std::vector<uint32_t> v;
  for (uint32_t k = 0; k < 6; ++k) v.push_back((lane * 7 + k * 5) % 11);
  std::sort(v.begin(), v.end());
  row.push_back(v[0] | v[1] << 4 | v[2] << 8 | v[3] << 12 | v[4] << 16 | v[5] << 20);
  const uint32_t next = (i + 1) % 3;
  row.push_back(i * 10 + next + 500 + (next * 10 + 2) * 10000);
  row.push_back(bits(float((i == 2 ? 0 : 20) + (lane & 1))));
  float q[4] = {1, 2, 3, 4};
  q[q4] *= 10;
  const float z = q[0], w = q[3];
  q[2] = z, q[0] = w, q[1] += 0.5f, q[3] += 0.5f;
  q[i] += q[3 - i];
  row.push_back(bits(q[0] + 10 * q[1] + 100 * q[2] + 1000 * q[3]));
  uint32_t history[5] = {};
  for (uint32_t k = 0; k <= lane % 5; ++k) history[k] = k * k + history[std::max(k, 1u) - 1];
  row.push_back(history[lane % 5]);
  return row;
}

TEST_CASE("arrays of arrays and structs are copied, passed and indexed dynamically") {
  RayLab lab({"arrays.rgen", {}, {}, {}});
  check_lanes(lab, arrays);
}

TEST_CASE("defines, include chains, macros and specialisation defaults reach the code") {
  RayLab lab({"constants.rgen",
              {},
              {},
              {{lab_file("more")}, {{"SAMPLES", "4"}, {"FEATURE", ""}, {"TEXT_VALUE", "(3u + 4u)"}}}});
  check_lanes(lab, [](uint32_t lane) {
    volatile const float product = float(lane) * 1.1f;  // rounds before the sum: `precise`
    return Row{10 * lane,    bits(0.25f), 4 * (lane + 1) * (lane + 1), 2,
               7 + lane * 7, 11,          bits(product + 2.2f),        36 + 460};
  });
}

TEST_CASE("storage images are read after writes of the same lane, textures by a lane's own index") {
  RayLab lab({"images.rgen", {}, {}, {}});
  check_lanes(lab, [](uint32_t lane) {
    const auto red = [](uint32_t t) { return bits(float(64 * t + 16) / 255.0f); };
    return Row{bits(float(lane & 1 ? 2 * lane : lane)),
               red(lane & 1),
               bits(10),
               bits(128.0f / 255.0f),
               red(1),
               red(0)};
  });
  CHECK(lab.image[4 * 9 + 0] == 18);
  CHECK(lab.image[4 * 9 + 2] == 2);
  CHECK(lab.image[4 * 10 + 3] == 1);
}

}  // namespace
}  // namespace glint::test
