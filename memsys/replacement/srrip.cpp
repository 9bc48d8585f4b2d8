// Implements the replacement policy `srrip`: it predicts how soon each line is used again, and the line that
// is expected latest makes way.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "base/registry.h"
#include "memsys/replacement.h"

namespace glint::mem {
namespace {

// This is static re-reference interval prediction with hit priority (Jaleel et al., ISCA 2010). A new line is
// expected late, and a line that is used again is expected at once. When no line is expected latest, all
// lines of the set age together. An unused slot is taken first. Model: where the lines that are expected
// latest are held, the latest of the others makes way.
class Srrip final : public Replacement {
 public:
  static constexpr const char* kName = "srrip";
  static constexpr const char* kDoc =
      "The line that is expected to be used again latest makes way (static re-reference interval "
      "prediction).";
  struct Params {
    uint32_t bits = 2;  // Jaleel et al.: 2 bits per line
    static ParamList params() {
      return {param(&Params::bits, "bits", "bit", "Bits of the expected interval that each line has.", 1, 7)};
    }
  };

  Srrip(const Params& params, const Context& context)
      : ways_(context.ways),
        latest_(uint8_t((1u << params.bits) - 1)),
        expected_(size_t{context.sets} * context.ways, latest_) {}

  uint32_t victim(uint32_t set, std::span<const CacheLine> lines) const override {
    const uint32_t first = set * ways_;
    if (const uint32_t unused = first_unused(lines, first, ways_); unused != kNone) return unused;
    uint32_t best = kNone;
    for (uint32_t slot = first; slot < first + ways_; ++slot)
      if (!lines[slot].held && (best == kNone || expected_[slot] > expected_[best])) best = slot;
    return best;
  }
  void filled(uint32_t slot) override {
    const auto set = expected_.begin() + ptrdiff_t(slot / ways_ * ways_);
    const uint8_t age = latest_ - expected_[slot];  // steps by which the set ages until this line is latest
    std::for_each(set, set + ways_, [&](uint8_t& line) { line = std::min<uint8_t>(line + age, latest_); });
    expected_[slot] = latest_ - 1;
  }
  void touched(uint32_t slot) override { expected_[slot] = 0; }
  void emptied(uint32_t slot) override { expected_[slot] = latest_; }

 private:
  const uint32_t ways_;
  const uint8_t latest_;
  std::vector<uint8_t> expected_;  // predicted re-reference interval, by slot
};

const Register<Replacement, Srrip> registered;

}  // namespace
}  // namespace glint::mem
