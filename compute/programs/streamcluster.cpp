// Chooses centres of clusters: a kernel prices each candidate, and the host opens those that pay.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "compute/programs/programs.h"

namespace glint::compute {
namespace {

struct Points {
  uint32_t count, dimensions;
  std::vector<float> coordinates, weights;  // coordinates by dimension, then by point

  // Returns the weighted square of the distance between two points.
  float cost(uint32_t point, uint32_t centre) const {
    float square = 0;
    for (uint32_t d = 0; d < dimensions; ++d) {
      const float away = coordinates[size_t(d) * count + point] - coordinates[size_t(d) * count + centre];
      square += away * away;
    }
    return square * weights[point];
  }
};

struct Clusters {
  std::vector<uint32_t> centre;  // of each point
  std::vector<float> costs;
  double opening;  // price of a centre
};

// Opens the candidate if that makes the whole cheaper, and then closes centres that no longer pay: their
// points go to the candidate. `changes` says what each point's cost would rise by.
void open_if_cheaper(uint32_t candidate, const std::vector<float>& changes, Clusters& clusters) {
  std::vector<double> losses(changes.size());  // by centre: what its other points lose when it closes
  std::vector<bool> is_centre(changes.size());
  double gain = -clusters.opening;
  for (uint32_t i = 0; i < changes.size(); ++i) {
    is_centre[clusters.centre[i]] = true;
    if (changes[i] < 0)
      gain -= double(changes[i]);
    else
      losses[clusters.centre[i]] += double(changes[i]);
  }
  for (uint32_t i = 0; i < changes.size(); ++i)
    if (is_centre[i] && losses[i] < clusters.opening) gain += clusters.opening - losses[i];
  if (gain <= 0) return;
  for (uint32_t i = 0; i < changes.size(); ++i) {
    if (changes[i] >= 0 && losses[clusters.centre[i]] >= clusters.opening) continue;
    clusters.centre[i] = candidate;
    clusters.costs[i] += changes[i];
  }
}

}  // namespace

void streamcluster(Host& host, Size size) {
  const bool full = size == Size::Full;
  Points points{full ? 16'384u : 1'024u, full ? 128u : 16u, {}, {}};
  points.coordinates = host.random.floats(size_t(points.count) * points.dimensions, 0, 1);
  points.weights = std::vector<float>(points.count, 1);
  Clusters clusters{std::vector<uint32_t>(points.count), {}, double(points.dimensions)};
  for (uint32_t i = 0; i < points.count; ++i) clusters.costs.push_back(points.cost(i, 0));
  const auto coordinates = host.buffer("coordinates", points.coordinates),
             weights = host.buffer("weights", points.weights), costs = host.buffer("costs", clusters.costs),
             changes = host.buffer<float>("changes", points.count);
  std::vector<float> expected(points.count);
  for (int round = 0; round < 16; ++round) {
    struct {
      uint32_t points, dimensions, candidate;
    } const constants{points.count, points.dimensions, host.random.below(points.count)};
    host.launch("streamcluster", {groups_of(points.count, 256), 1, 1}, {coordinates, weights, costs, changes},
                constants);
    for (uint32_t i = 0; i < points.count; ++i)
      expected[i] = points.cost(i, constants.candidate) - clusters.costs[i];
    host.check("changes", changes, expected);
    open_if_cheaper(constants.candidate, expected, clusters);
    std::ranges::copy(clusters.costs, host.view(costs).begin());
  }
}

}  // namespace glint::compute
