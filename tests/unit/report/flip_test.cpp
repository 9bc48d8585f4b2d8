// Tests FLIP against values that flip_values.py computes from the paper's formulas, and tests its properties.
// SPDX-License-Identifier: Apache-2.0
#include "report/picture/flip.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <utility>

#include "base/diagnostics.h"
#include "tests/support/catch.h"

using namespace glint;
using report::Picture;

namespace {

constexpr uint32_t kWidth = 20, kHeight = 14;

template <class Channel>
Picture make(const Channel& channel) {
  Picture out{kWidth, kHeight, {}};
  for (uint32_t y = 0; y < kHeight; ++y)
    for (uint32_t x = 0; x < kWidth; ++x)
      for (uint32_t c = 0; c < 3; ++c) out.rgb.push_back(channel(x, y, c));
  return out;
}

Picture noise(uint32_t seed) {
  return make([&](uint32_t x, uint32_t y, uint32_t c) {
    return float((x * 37 + y * 101 + c * 53 + x * y * 7 + seed * 71) % 97) / 96.0f;
  });
}
Picture edge(uint32_t at) {
  return make([&](uint32_t x, uint32_t, uint32_t) { return x >= at ? 0.75f : 0.25f; });
}
Picture plain(float value) {
  return make([&](uint32_t, uint32_t, uint32_t) { return value; });
}

// Makes the same pictures as pair() of flip_values.py.
std::pair<Picture, Picture> pair(const std::string& name) {
  if (name == "noise") return {noise(1), noise(2)};
  if (name == "edge") return {edge(9), edge(11)};
  if (name == "ends") return {plain(0), plain(1)};
  const auto red = [](bool spot) {
    return make([=](uint32_t x, uint32_t y, uint32_t c) {
      return c == (spot && x >= 6 && x < 13 && y >= 4 && y < 9 ? 1u : 0u) ? 1.0f : 0.0f;
    });
  };
  return {red(false), red(true)};
}

}  // namespace

TEST_CASE(
    "FLIP is what the paper's formulas give, pixel by pixel and in the mean, at three viewing distances") {
  std::ifstream file(GLINT_SOURCE_DIR "/tests/unit/report/flip_values.csv");
  std::string line, name, before;
  REQUIRE(std::getline(file, line));
  report::Flip measured;
  int rows = 0;
  for (; std::getline(file, line); ++rows) {
    for (char& c : line) c = c == ',' ? ' ' : c;
    std::istringstream cells(line);
    double ppd = 0, value = 0;
    int x = 0, y = 0;
    REQUIRE(cells >> name >> ppd >> x >> y >> value);
    if (x < 0) {
      const auto [a, b] = pair(name);
      measured = report::flip(a, b, ppd);
      CHECK(measured.mean == Approx(value).margin(1e-6));
    } else {
      INFO(name << " at " << ppd << " pixels per degree, pixel " << x << ", " << y);
      CHECK(double(measured.map[size_t(y) * kWidth + size_t(x)]) == Approx(value).margin(1e-6));
    }
  }
  CHECK(rows == 6 * 26);
}

TEST_CASE("FLIP of a picture and itself is 0, and it is the same both ways round") {
  const report::Flip same = report::flip(noise(3), noise(3)), there = report::flip(noise(1), edge(9)),
                     back = report::flip(edge(9), noise(1));
  CHECK(same.mean == 0);
  CHECK(std::all_of(same.map.begin(), same.map.end(), [](float v) { return v == 0; }));
  CHECK(there.map == back.map);
  CHECK(there.mean > 0.1);
}

TEST_CASE("FLIP of black and white is near its end, nearer than of greys, and no value leaves 0 to 1") {
  const double ends = report::flip(plain(0), plain(1)).mean,
               greys = report::flip(plain(0.4f), plain(0.5f)).mean;
  CHECK(ends > 0.96);
  CHECK(ends <= 1.0);
  CHECK(greys > 0.05);
  CHECK(greys < 0.5);
  for (const float v : report::flip(noise(1), noise(2), 5).map) CHECK((v >= 0 && v <= 1));
}

TEST_CASE(
    "FLIP sees less of fine noise from far away than from near, and has no mean with what is not finite in "
    "one picture only") {
  CHECK(report::flip(noise(1), noise(2), 200).mean < report::flip(noise(1), noise(2), 20).mean);
  Picture broken = plain(0);
  broken.rgb[7] = std::nanf("");
  broken.rgb[8] = -INFINITY;
  CHECK(report::flip(broken, broken).mean == 0);
  const report::Flip beyond = report::flip(plain(0), broken);
  CHECK(std::isnan(beyond.mean));
  CHECK(beyond.map[2] == 1);
  CHECK(beyond.map[1] == 0);
}

TEST_CASE(
    "FLIP refuses pictures of two sizes and absurd viewing distances, and draws its map from dark to light") {
  CHECK_THROWS_AS(report::flip(plain(0), Picture{1, 1, {0, 0, 0}}), UserError);
  CHECK_THROWS_AS(report::flip(plain(0), plain(1), 0), UserError);
  const Picture drawn = report::flip_picture({3, 1, {}}, {0.5, {0, 0.5f, 1}});
  const auto light = [&](size_t p) { return drawn.rgb[3 * p] + drawn.rgb[3 * p + 1] + drawn.rgb[3 * p + 2]; };
  CHECK(light(0) < 0.1f);
  CHECK(light(0) < light(1));
  CHECK(light(1) < light(2));
}
