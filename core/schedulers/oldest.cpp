// Implements the issue policy `oldest`: it always takes the ready warp that was launched first.
// SPDX-License-Identifier: Apache-2.0
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

  uint32_t pick(const IssueView& view) override { return oldest_of(view.ready, view); }
};

const Register<IssueScheduler, OldestFirst> registered;

}  // namespace
}  // namespace glint::core
