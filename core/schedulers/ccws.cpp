// Implements the issue policy `ccws`: warps that lose their lines in the L1 to others hold the loads of
// others back.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/issue_scheduler.h"

namespace glint::core {
namespace {

// This is cache-conscious wavefront scheduling (Rogers, O'Connor and Aamodt, MICRO 2012). Tags of the lines
// that a warp has lost to others are kept for each warp. A miss that finds its tag there is lost locality. It
// gives the warp a score, which falls by one in each cycle down to a base score. The scores are piled up, the
// largest at the bottom, and warps that lie above the sum of all base scores issue no loads. Among the other
// warps, the policy is greedy then oldest. Choice: A warp that lies partly above the sum is not held back, so
// that one warp can always go on. Model: Each scheduler keeps the scores of its own warps; the paper keeps
// those of a core together. Stores and accesses to shared memory are held back as loads are, and reads of
// textures are not. Lines that the RT unit reads have no scores.
class Ccws final : public IssueScheduler, public L1Listener {
 public:
  static constexpr std::string_view kName = "ccws";
  static constexpr std::string_view kDoc =
      "A scheduler holds memory instructions of some warps back while others lose lines of the L1 that they "
      "use again. Of the other warps, it issues from the same one as long as it is ready, and then from the "
      "oldest (cache-conscious wavefront scheduling).";
  struct Params {
    // Rogers et al.: tags of 16 lines for each warp in sets of 8, and a base score of 100. Choice: The scores
    // of a scheduler, which has a fourth of a core's warps, fall as slowly as the paper's with a base of 400.
    // The throttle is a guess.
    uint32_t base = 400, tags = 16, ways = 8, throttle = 8;
    static ParamList params() {
      return {
          param(&Params::base, "base", "cycle",
                "Score of a warp without lost locality. Scores above it fall by one in a cycle.", 1,
                1'000'000),
          param(&Params::tags, "tags", "line", "Number of lost lines that are remembered for each warp.", 1,
                4096),
          param(&Params::ways, "ways", "line", "Number of remembered lines in a set.", 1, 4096),
          param(&Params::throttle, "throttle", "",
                "Factor by which lost locality for each instruction raises a warp's score.", 1, 1'000'000),
      };
    }
  };
  Ccws(Params params, Context context)
      : base_(params.base),
        throttle_(params.throttle),
        ways_(std::min(params.ways, params.tags)),
        sets_(params.tags / ways_),
        tags_(size_t{context.num_warps} * sets_ * ways_, kNoLine) {}

  L1Listener* l1_listener() override { return this; }
  bool holds_back() const override { return true; }

  void start(uint32_t lines) override { owner_.resize(lines, kNobody); }
  void missed(uint32_t warp, Address line) override {
    const auto set = set_of(warp, line);
    const auto found = std::find(set, set + ways_, line);
    if (found == set + ways_) return;
    std::rotate(set, found, found + 1);
    *set = kNoLine;
    ++lost_;
    is_hit_ |= uint64_t{1} << warp;
  }
  void replaced(uint32_t place, std::optional<uint32_t> warp, std::optional<Address> victim) override {
    const uint32_t owner = std::exchange(owner_[place], warp ? *warp : kNobody);
    if (!victim || owner == kNobody) return;
    const auto set = set_of(owner, *victim);
    std::rotate(set, set + ways_ - 1, set + ways_);
    *set = *victim;
  }

  uint64_t allowed(const IssueView& view) override {
    raise_scores(view);
    const uint64_t at_memory = view.ready & view.at_memory;
    if (view.now >= raised_until_ || !at_memory) return view.ready;
    uint64_t allowed = view.ready & ~at_memory;
    uint64_t sum = 0;
    for (uint64_t left = view.resident; left && sum < base_sum(view);) {
      const uint32_t warp = highest(left, view);
      allowed |= at_memory & uint64_t{1} << warp;
      left &= ~(uint64_t{1} << warp);
      sum += score(warp, view);
    }
    return allowed;
  }
  uint32_t pick(const IssueView& view) override {
    ++issued_;
    return last_.is_ready(view) ? last_.warp() : last_.note(oldest_of(view.ready, view), view);
  }

 private:
  static constexpr uint32_t kNobody = ~0u;
  static constexpr Address kNoLine = ~Address{0};
  struct Score {
    uint64_t age = ~uint64_t{0};  // the warp that has it
    Cycle until = 0;              // when it has fallen to the base
  };

  std::vector<Address>::iterator set_of(uint32_t warp, Address line) {
    return tags_.begin() + ptrdiff_t((size_t{warp} * sets_ + line / kSetStride % sets_) * ways_);
  }
  // Returns the sum of the base scores of all warps.
  uint64_t base_sum(const IssueView& view) const {
    return uint64_t{base_} * uint64_t(std::popcount(view.resident));
  }
  uint64_t score(uint32_t warp, const IssueView& view) const {
    const Score& at = scores_[warp];
    return base_ + (at.age == view.age[warp] && at.until > view.now ? at.until - view.now : 0);
  }
  // Returns the warp with the highest score, of equals the oldest.
  uint32_t highest(uint64_t warps, const IssueView& view) const {
    auto best = uint32_t(std::countr_zero(warps));
    for (uint64_t rest = warps & (warps - 1); rest; rest &= rest - 1) {
      const auto i = uint32_t(std::countr_zero(rest));
      const uint64_t own = score(i, view), other = score(best, view);
      if (own != other ? own > other : view.age[i] < view.age[best]) best = i;
    }
    return best;
  }
  // Gives the warps that have lost lines since the last call the score of the paper's equation: lost lines
  // for each instruction issued so far, times the factor and the sum of all base scores.
  void raise_scores(const IssueView& view) {
    if (!is_hit_) return;
    const uint64_t raised = lost_ * throttle_ * base_sum(view) / std::max<uint64_t>(issued_, 1);
    for (; is_hit_; is_hit_ &= is_hit_ - 1) {
      const auto warp = uint32_t(std::countr_zero(is_hit_));
      scores_[warp] = {view.age[warp], view.now + (raised > base_ ? raised - base_ : 0)};
      raised_until_ = std::max(raised_until_, scores_[warp].until);
    }
  }

  static constexpr Address kSetStride = 128;  // bytes of a line of most L1s
  const uint32_t base_, throttle_, ways_, sets_;
  std::vector<Address> tags_;    // lost lines by warp and set, the newest first
  std::vector<uint32_t> owner_;  // by place of the L1: the warp that asked for its line
  std::array<Score, kMaxWarpsPerScheduler> scores_{};
  uint64_t is_hit_ = 0;  // bit i: warp i has lost locality since the scores were raised last
  uint64_t lost_ = 0, issued_ = 0;
  Cycle raised_until_ = 0;  // No score is above the base from then on.
  LastIssued last_;
};

const Register<IssueScheduler, Ccws> registered;

}  // namespace
}  // namespace glint::core
