// Implements the way `heat`: cells form clusters by what they cost, and each cluster has its share of
// segments.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "pipeline/sampling/sample_way.h"

namespace glint::pipeline {
namespace {

constexpr int kRounds = 20;  // k-means of one number settles in fewer

// Returns where each cluster begins in the sorted costs: k-means of one number, from equal parts on. The
// clusters of sorted numbers are runs of them. The last entry is the number of costs.
std::vector<size_t> cluster_borders(const std::vector<double>& sorted, size_t clusters) {
  std::vector<size_t> borders(clusters + 1);
  for (size_t c = 0; c <= clusters; ++c) borders[c] = sorted.size() * c / clusters;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> means(clusters);
    for (size_t c = 0; c < clusters; ++c) {
      double sum = 0;
      for (size_t i = borders[c]; i < borders[c + 1]; ++i) sum += sorted[i];
      means[c] = sum / std::max<double>(1, double(borders[c + 1] - borders[c]));
    }
    for (size_t c = 1; c < clusters; ++c) {
      const auto at = std::ranges::lower_bound(sorted, (means[c - 1] + means[c]) / 2) - sorted.begin();
      // A cluster keeps one cell, so that it has a mean.
      borders[c] = std::clamp(size_t(at), borders[c - 1] + 1, sorted.size() - (clusters - c));
    }
  }
  return borders;
}

// Source of the clusters: Zatel (Grigoryan et al., ISPASS 2024), which clusters the pixels of a heat map.
class Heat final : public SampleWay {
 public:
  static constexpr std::string_view kName = "heat";
  static constexpr std::string_view kDoc =
      "Cells form clusters by their functional cost, as in Zatel, and each cluster has segments in random "
      "cells in proportion to its size.";
  struct Params {
    uint32_t clusters = 5;
    static ParamList params() {
      return {param(&Params::clusters, "clusters", "cluster", "Number of clusters of cells.", 1, 1000)};
    }
  };
  Heat(const Params& params, Context) : clusters_(params.clusters) {}

  bool needs_costs() const override { return true; }
  std::vector<uint32_t> begins(const SamplePlaces& places, SplitMix& numbers) const override {
    const std::vector<uint32_t> order = cells_by_cost(places);
    std::vector<double> sorted;
    for (const uint32_t cell : order) sorted.push_back(places.costs[cell]);
    const std::vector<size_t> borders = cluster_borders(sorted, std::min<size_t>(clusters_, places.segments));
    std::vector<uint32_t> drawn;
    for (size_t c = 0; c + 1 < borders.size(); ++c) {
      // The segments up to the end of a cluster are as many as its share of all cells, so none is left over.
      const auto wanted =
          size_t(std::lround(double(places.segments) * double(borders[c + 1]) / double(order.size())));
      std::vector<uint32_t> cells(order.begin() + long(borders[c]), order.begin() + long(borders[c + 1]));
      while (drawn.size() < wanted && !cells.empty()) {
        std::swap(cells[numbers.below(uint32_t(cells.size()))], cells.back());
        drawn.push_back(cells.back());
        cells.pop_back();
      }
    }
    return begins_of(places, std::move(drawn));
  }

 private:
  const uint32_t clusters_;
};

const Register<SampleWay, Heat> registered;

}  // namespace
}  // namespace glint::pipeline
