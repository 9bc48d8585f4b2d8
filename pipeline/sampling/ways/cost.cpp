// Implements the way `cost`: cells are sorted by what they cost, and each part of the order has one segment.
// SPDX-License-Identifier: Apache-2.0
#include <string_view>
#include <utility>

#include "pipeline/sampling/sample_way.h"

namespace glint::pipeline {
namespace {

class Cost final : public SampleWay {
 public:
  static constexpr std::string_view kName = "cost";
  static constexpr std::string_view kDoc =
      "Cells are sorted by their functional cost, and a segment lies in a random cell of each equal part of "
      "the order.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Cost(Params, Context) {}

  bool needs_costs() const override { return true; }
  std::vector<uint32_t> begins(const SamplePlaces& places, SplitMix& numbers) const override {
    const std::vector<uint32_t> order = cells_by_cost(places);
    std::vector<uint32_t> drawn;
    for (uint32_t part = 0; part < places.segments; ++part) {
      const auto first = uint32_t(order.size() * part / places.segments),
                 last = uint32_t(order.size() * (part + 1) / places.segments);
      drawn.push_back(order[first + numbers.below(last - first)]);
    }
    return begins_of(places, std::move(drawn));
  }
};

const Register<SampleWay, Cost> registered;

}  // namespace
}  // namespace glint::pipeline
