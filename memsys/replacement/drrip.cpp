// Implements the replacement policy `drrip`: two ways to predict how soon a new line is used again compete in
// some sets, and the other sets follow the way that misses less.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <span>

#include "base/registry.h"
#include "memsys/replacement/intervals.h"
#include "memsys/replacement/set_duel.h"

namespace glint::mem {
namespace {

// This is dynamic re-reference interval prediction (Jaleel et al., ISCA 2010). Its first way is SRRIP, where
// a new line is expected late. Its second is BRRIP, where a new line is expected latest but for one in 32, so
// that a part of a working set that is larger than the cache stays in it. Choice: Every 32nd line that is
// filled by BRRIP is the one, counted over the whole cache; the paper says "with low probability". Model:
// What counts as a miss is a line that is filled. A miss of a sector whose line is present counts as a hit.
class Drrip final : public Replacement {
 public:
  static constexpr const char* kName = "drrip";
  static constexpr const char* kDoc =
      "As with srrip, but new lines may be expected latest, so that they make way first. Some sets try "
      "each of both, and the others follow what misses less.";
  struct Params {
    // Jaleel et al.: 2 bits per line, 32 sets for each policy, a counter of 10 bits, 1 of 32 lines
    uint32_t bits = 2, leaders = 32, counter_bits = 10, rare = 32;
    static ParamList params() {
      return {
          param(&Params::bits, "bits", "bit", "Bits of the expected interval that each line has.", 1, 7),
          param(&Params::leaders, "leaders", "set",
                "Number of sets that always use each of the two policies. At most half of the sets do.", 1,
                65536),
          param(&Params::counter_bits, "counter_bits", "bit",
                "Bits of the counter that says which policy misses less.", 1, 31),
          param(
              &Params::rare, "rare", "line",
              "Number of lines that the second policy fills for each one that it expects before the latest.",
              1, 65536),
      };
    }
  };

  Drrip(const Params& params, const Context& context)
      : rare_(params.rare),
        intervals_(context, params.bits),
        duel_(context.sets, params.leaders, params.counter_bits) {}

  uint32_t victim(uint32_t set, std::span<const CacheLine> lines) const override {
    return intervals_.victim(set, lines);
  }
  void filled(uint32_t slot) override {
    const uint32_t set = intervals_.set_of(slot);
    duel_.missed(set);
    const bool expects_latest = duel_.uses_second(set) && !is_rare();
    intervals_.fill(slot, uint8_t(intervals_.latest() - (expects_latest ? 0 : 1)));
  }
  void touched(uint32_t slot) override { intervals_.touch(slot); }
  void emptied(uint32_t slot) override { intervals_.empty(slot); }

 private:
  // Says whether the line that the second policy fills now is one of the few.
  bool is_rare() {
    until_rare_ = (until_rare_ == 0 ? rare_ : until_rare_) - 1;
    return until_rare_ == 0;
  }

  const uint32_t rare_;
  uint32_t until_rare_ = 0;  // lines that the second policy fills before the next rare one
  Intervals intervals_;
  SetDuel duel_;
};

const Register<Replacement, Drrip> registered;

}  // namespace
}  // namespace glint::mem
