// Implements the replacement policy `random`: a seeded sequence draws the line of the set that makes way.
// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include "base/registry.h"
#include "memsys/replacement.h"

namespace glint::mem {
namespace {

// Returns the mixing function of SplitMix64 (Steele, Lea, Flood, OOPSLA 2014), in which every input bit
// reaches every output bit.
uint64_t mix(uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58'476d'1ce4'e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d0'49bb'1331'11ebull;
  return x ^ (x >> 31);
}

// An unused slot is taken first. Each set has a sequence of its own: draw n of a set depends on the seed, the
// set and n. Model: where the drawn line is held, the next line that is not held makes way. A line behind
// held lines therefore makes way more often than others.
class Random final : public Replacement {
 public:
  static constexpr const char* kName = "random";
  static constexpr const char* kDoc = "A line of the set that a seeded sequence draws makes way.";
  struct Params {
    uint32_t seed = 1;
    static ParamList params() {
      return {param(&Params::seed, "seed", "", "Number that selects the sequence of draws.", 0, ~0u)};
    }
  };

  Random(const Params& params, const Context& context)
      : ways_(context.ways), seed_(mix(params.seed + 1)), draws_(context.sets) {}

  uint32_t victim(uint32_t set, std::span<const CacheLine> lines) const override {
    const uint32_t first = set * ways_;
    if (const uint32_t unused = first_unused(lines, first, ways_); unused != kNone) return unused;
    const auto drawn = uint32_t(mix(seed_ + (uint64_t{set} << 40) + draws_[set]) % ways_);
    for (uint32_t i = 0; i < ways_; ++i)
      if (const uint32_t slot = first + (drawn + i) % ways_; !lines[slot].held) return slot;
    return kNone;
  }
  void filled(uint32_t slot) override { ++draws_[slot / ways_]; }
  void touched(uint32_t) override {}

 private:
  const uint32_t ways_;
  const uint64_t seed_;
  std::vector<uint64_t> draws_;  // number of lines that were filled, by set
};

const Register<Replacement, Random> registered;

}  // namespace
}  // namespace glint::mem
