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
    return last_.is_ready(view) ? last_.warp() : last_.note(oldest_of(view.ready, view), view);
  }

 private:
  LastIssued last_;
};

const Register<IssueScheduler, GreedyThenOldest> registered;

}  // namespace
}  // namespace glint::core
