// Implements the issue policy `lrr`: loose round robin takes the next ready warp after the one issued last.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <string_view>

#include "core/issue_scheduler.h"

namespace glint::core {
namespace {

class LooseRoundRobin final : public IssueScheduler {
 public:
  static constexpr std::string_view kName = "lrr";
  static constexpr std::string_view kDoc =
      "A scheduler issues from the next ready warp after the one that it issued from last (loose round "
      "robin).";
  struct Params {
    static ParamList params() { return {}; }
  };
  LooseRoundRobin(Params, Context context) : last_(context.num_warps - 1) {}

  uint32_t pick(const IssueView& view) override {
    // There are two shifts, because a shift by 64 is undefined.
    const uint64_t after = view.ready & (~uint64_t{0} << last_ << 1);
    last_ = uint32_t(std::countr_zero(after ? after : view.ready));
    return last_;
  }

 private:
  uint32_t last_;
};

const Register<IssueScheduler, LooseRoundRobin> registered;

}  // namespace
}  // namespace glint::core
