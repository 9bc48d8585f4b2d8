// Implements the issue policy `oldest`: it always takes the ready warp that was launched first.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <string_view>

#include "core/issue_scheduler.h"

namespace glint::core {
namespace {

class OldestFirst final : public IssueScheduler {
 public:
  static constexpr std::string_view kName = "oldest";
  static constexpr std::string_view kDoc = "A scheduler issues from the ready warp that was launched first.";
  struct Params {
    static ParamList params() { return {}; }
  };
  OldestFirst(Params, Context) {}

  uint32_t pick(const IssueView& view) override {
    uint32_t oldest = uint32_t(std::countr_zero(view.ready));
    for (uint64_t rest = view.ready & (view.ready - 1); rest; rest &= rest - 1) {
      const uint32_t i = uint32_t(std::countr_zero(rest));
      if (view.age[i] < view.age[oldest]) oldest = i;
    }
    return oldest;
  }
};

const Register<IssueScheduler, OldestFirst> registered;

}  // namespace
}  // namespace glint::core
