// Implements the issue policy `rt_aware`: while the RT unit has room, the warp that is nearest to its next
// rays goes first.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <bit>
#include <cstdint>
#include <string_view>

#include "core/issue_scheduler.h"

namespace glint::core {
namespace {

// Choice: there is no published form of this policy. How far a warp is from its next rays is not known, so
// the one that has issued most since its last rays is taken to be nearest, as if all stretches between rays
// had the same length. An RT unit without room gains nothing from further rays: the oldest warp goes first.
class RtAware final : public IssueScheduler {
 public:
  static constexpr std::string_view kName = "rt_aware";
  static constexpr std::string_view kDoc =
      "While the RT unit has room, a scheduler issues from a warp that gives rays to it, and then from the "
      "warp that has issued most since its last rays; while it has none, from the same warp as long as it is "
      "ready, and then from the oldest.";
  struct Params {
    static ParamList params() { return {}; }
  };
  RtAware(Params, Context) {}

  bool needs_rt() const override { return true; }

  uint32_t pick(const IssueView& view) override {
    const uint64_t at_rays = view.ready & view.rt.at_rays;
    const uint32_t warp = view.rt.has_room && at_rays ? oldest_of(at_rays, view)
                          : view.rt.has_room          ? nearest(view)
                                                      : same_or_oldest(view);
    Progress& progress = progress_[warp];
    if (progress.age != view.age[warp]) progress = {view.age[warp], 0};
    progress.issued = view.rt.at_rays >> warp & 1 ? 0 : progress.issued + 1;
    last_ = warp;
    return warp;
  }

 private:
  // Holds how much a warp has issued since it started or gave its last rays to the unit.
  struct Progress {
    uint64_t age = ~uint64_t{0}, issued = 0;
  };

  uint64_t issued(uint32_t warp, const IssueView& view) const {
    return progress_[warp].age == view.age[warp] ? progress_[warp].issued : 0;
  }
  // Of warps that have issued equally much, the oldest is taken.
  uint32_t nearest(const IssueView& view) const {
    uint64_t most = 0, warps = 0;
    for (uint64_t rest = view.ready; rest; rest &= rest - 1) {
      const uint32_t i = uint32_t(std::countr_zero(rest));
      const uint64_t own = issued(i, view);
      if (own > most) warps = 0;
      if (own >= most) {
        most = own;
        warps |= uint64_t{1} << i;
      }
    }
    return oldest_of(warps, view);
  }
  uint32_t same_or_oldest(const IssueView& view) const {
    const bool is_same = (view.ready >> last_ & 1) && progress_[last_].age == view.age[last_];
    return is_same ? last_ : oldest_of(view.ready, view);
  }

  std::array<Progress, kMaxWarpsPerScheduler> progress_{};
  uint32_t last_ = 0;
};

const Register<IssueScheduler, RtAware> registered;

}  // namespace
}  // namespace glint::core
