// Implements the coalescer `each_lane`: every lane fetches for itself.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/coalescer.h"

namespace glint::rt {
namespace {

class EachLane final : public Coalescer {
 public:
  static constexpr std::string_view kName = "each_lane";
  static constexpr std::string_view kDoc = "Every lane fetches its node for itself.";
  struct Params {
    static ParamList params() { return {}; }
  };
  EachLane(Params, Context) {}

  uint64_t partners(uint32_t, std::span<const WarpView>) const override { return 0; }
};

const Register<Coalescer, EachLane> registered;

}  // namespace
}  // namespace glint::rt
