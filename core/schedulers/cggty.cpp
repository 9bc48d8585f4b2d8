// Implements the issue policy `cggty`: it takes the warp issued last while that is ready, else the youngest
// ready warp.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <string_view>

#include "core/issue_scheduler.h"

namespace glint::core {
namespace {

// Source: "Analyzing Modern NVIDIA GPU cores", MICRO 2025, section 5.1.2: compiler-guided greedy, then
// youngest. Model: the compiler guides by stall counts; the ready times of the scoreboard take their place.
// Its yield bit, which asks for another warp once, does not exist in this ISA.
class GreedyThenYoungest final : public IssueScheduler {
 public:
  static constexpr std::string_view kName = "cggty";
  static constexpr std::string_view kDoc =
      "A scheduler issues from the same warp as long as it is ready, and then from the youngest ready warp "
      "(compiler-guided greedy then youngest).";
  struct Params {
    static ParamList params() { return {}; }
  };
  GreedyThenYoungest(Params, Context) {}

  uint32_t pick(const IssueView& view) override {
    if (last_.is_ready(view)) return last_.warp();
    uint32_t youngest = uint32_t(std::countr_zero(view.ready));
    for (uint64_t rest = view.ready & (view.ready - 1); rest; rest &= rest - 1) {
      const uint32_t i = uint32_t(std::countr_zero(rest));
      if (view.age[i] > view.age[youngest]) youngest = i;
    }
    return last_.note(youngest, view);
  }

 private:
  LastIssued last_;
};

const Register<IssueScheduler, GreedyThenYoungest> registered;

}  // namespace
}  // namespace glint::core
