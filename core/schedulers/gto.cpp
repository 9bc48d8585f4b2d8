// Implements the issue policy `gto`: it takes the warp issued last while that is ready, else the oldest ready
// warp.
// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "core/issue_scheduler.h"

namespace glint::core {
namespace {

// Source: Rogers et al., "Cache-Conscious Wavefront Scheduling", MICRO 2012, section 5: greedy then oldest.
class GreedyThenOldest final : public IssueScheduler {
 public:
  static constexpr std::string_view kName = "gto";
  static constexpr std::string_view kDoc =
      "A scheduler issues from the same warp as long as it is ready, and then from the oldest ready warp "
      "(greedy then oldest).";
  struct Params {
    static ParamList params() { return {}; }
  };
  GreedyThenOldest(Params, Context) {}

  uint32_t pick(const IssueView& view) override {
    // A new warp in the same slot is not the warp that was issued last.
    if ((view.ready >> last_ & 1) && view.age[last_] == last_age_) return last_;
    last_ = oldest_of(view.ready, view);
    last_age_ = view.age[last_];
    return last_;
  }

 private:
  uint32_t last_ = 0;
  uint64_t last_age_ = ~uint64_t{0};
};

const Register<IssueScheduler, GreedyThenOldest> registered;

}  // namespace
}  // namespace glint::core
