// Implements the way `position`: the launch is cut into equal parts, and each has one segment.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string_view>

#include "pipeline/sampling/sample_way.h"

namespace glint::pipeline {
namespace {

class Position final : public SampleWay {
 public:
  static constexpr std::string_view kName = "position";
  static constexpr std::string_view kDoc =
      "The launch is cut into equal parts, and a segment begins at a random place of each.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Position(Params, Context) {}

  std::vector<uint32_t> begins(const SamplePlaces& places, SplitMix& numbers) const override {
    std::vector<uint32_t> out;
    const auto border = [&](uint32_t part) {
      return uint32_t(uint64_t{places.num_blocks} * part / places.segments);
    };
    for (uint32_t part = 0; part < places.segments; ++part) {
      const uint32_t first = border(part), room = border(part + 1) - first;
      out.push_back(first + numbers.below(std::max(places.span, room) - places.span + 1));
    }
    return out;
  }
};

const Register<SampleWay, Position> registered;

}  // namespace
}  // namespace glint::pipeline
