// Finds the records of storms that are nearest to a place; the host chooses among the distances.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include "compute/programs/programs.h"

namespace glint::compute {
namespace {

// Returns the numbers of the `count` least distances, the least first.
std::vector<uint32_t> least(std::span<const float> distances, size_t count) {
  std::vector<uint32_t> out(distances.size());
  std::iota(out.begin(), out.end(), 0u);
  std::ranges::partial_sort(out, out.begin() + ptrdiff_t(count), [&](uint32_t a, uint32_t b) {
    return distances[a] != distances[b] ? distances[a] < distances[b] : a < b;
  });
  out.resize(count);
  return out;
}

struct Target {
  float latitude, longitude;
  uint32_t records;
};

}  // namespace

void nn(Host& host, Size size) {
  const Target target{30, 90, size == Size::Full ? 42'764u : 4'096u};
  std::vector<float> places, expected;
  for (uint32_t i = 0; i < target.records; ++i) {
    const float latitude = host.random.between(7, 63), longitude = host.random.between(0, 358),
                x = latitude - target.latitude, y = longitude - target.longitude;
    places.insert(places.end(), {latitude, longitude});
    expected.push_back(std::sqrt(x * x + y * y));
  }
  const auto distances = host.buffer<float>("distances", target.records);
  host.launch("nn", {groups_of(target.records, 256), 1, 1}, {host.buffer("places", places), distances},
              target);
  host.check("distances", distances, expected);
  const std::vector<uint32_t> found = least(host.view(distances), 5);
  host.check("nearest", host.buffer("nearest", found), least(expected, 5));
}

}  // namespace glint::compute
