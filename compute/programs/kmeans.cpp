// Clusters points around means: the kernels assign the points, and the host moves the centres (Lloyd).
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "compute/programs/programs.h"

namespace glint::compute {
namespace {

constexpr uint32_t kFeatures = 34, kClusters = 5;  // as in the records of the KDD Cup 1999

int32_t nearest(const float* point, const std::vector<float>& centres) {
  int32_t out = -1;
  float least = 3.4e38f;
  for (uint32_t cluster = 0; cluster < kClusters; ++cluster) {
    float sum = 0;
    for (uint32_t i = 0; i < kFeatures; ++i) {
      const float difference = point[i] - centres[cluster * kFeatures + i];
      sum += difference * difference;
    }
    if (sum < least) least = sum, out = int32_t(cluster);
  }
  return out;
}

// Moves each centre to the mean of its points. A centre without points stays.
void move_centres(const std::vector<float>& points, std::span<const int32_t> membership,
                  std::vector<float>& centres) {
  std::vector<double> sums(centres.size());
  uint64_t counts[kClusters] = {};
  for (size_t point = 0; point < membership.size(); ++point) {
    ++counts[membership[point]];
    for (uint32_t i = 0; i < kFeatures; ++i)
      sums[membership[point] * kFeatures + i] += points[point * kFeatures + i];
  }
  for (size_t i = 0; i < centres.size(); ++i)
    if (counts[i / kFeatures] > 0) centres[i] = float(sums[i] / double(counts[i / kFeatures]));
}

}  // namespace

void kmeans(Host& host, Size size) {
  const uint32_t count = size == Size::Full ? 494'020 : 2'800, rounds = size == Size::Full ? 4 : 8;
  const std::vector<float> points = host.random.floats(size_t(count) * kFeatures, 0, 255);
  std::vector<float> centres(points.begin(), points.begin() + kClusters * kFeatures);
  const auto by_point = host.buffer("points", points),
             by_feature = host.buffer<float>("points by feature", points.size()),
             middles = host.buffer<float>("centres", centres.size());
  const auto membership = host.buffer<int32_t>("membership", count);
  struct {
    uint32_t points, features, clusters;
  } const constants{count, kFeatures, kClusters};
  const std::array<uint32_t, 3> groups{groups_of(count, 256), 1, 1};
  host.launch("kmeans_swap", groups, {by_point, by_feature}, constants);
  std::vector<int32_t> expected(count, -1), before;
  for (uint32_t round = 0; round < rounds && expected != before; ++round) {
    before = expected;
    std::ranges::copy(centres, host.view(middles).begin());
    host.launch("kmeans", groups, {by_feature, middles, membership}, constants);
    for (uint32_t point = 0; point < count; ++point)
      expected[point] = nearest(&points[size_t(point) * kFeatures], centres);
    host.check("membership", membership, expected);
    move_centres(points, expected, centres);
  }
}

}  // namespace glint::compute
