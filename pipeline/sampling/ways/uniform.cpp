// Implements the way `uniform`: segments lie anywhere.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string_view>

#include "pipeline/sampling/sample_way.h"

namespace glint::pipeline {
namespace {

class Uniform final : public SampleWay {
 public:
  static constexpr std::string_view kName = "uniform";
  static constexpr std::string_view kDoc = "Segments begin at random places of the whole launch.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Uniform(Params, Context) {}

  // The blocks between segments are shared out at random, so that no two segments overlap.
  std::vector<uint32_t> begins(const SamplePlaces& places, SplitMix& numbers) const override {
    const uint32_t free = places.num_blocks - places.segments * places.span;
    std::vector<uint32_t> out(places.segments);
    for (uint32_t& begin : out) begin = numbers.below(free + 1);
    std::ranges::sort(out);
    for (uint32_t i = 0; i < places.segments; ++i) out[i] += i * places.span;
    return out;
  }
};

const Register<SampleWay, Uniform> registered;

}  // namespace
}  // namespace glint::pipeline
