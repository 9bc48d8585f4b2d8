// Implements the replacement policy `srrip`: it predicts how soon each line is used again, and the line that
// is expected latest makes way.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <span>

#include "base/registry.h"
#include "memsys/replacement/intervals.h"

namespace glint::mem {
namespace {

// This is static re-reference interval prediction (Jaleel et al., ISCA 2010): a new line is expected late.
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

  Srrip(const Params& params, const Context& context) : intervals_(context, params.bits) {}

  uint32_t victim(uint32_t set, std::span<const CacheLine> lines) const override {
    return intervals_.victim(set, lines);
  }
  void filled(uint32_t slot) override { intervals_.fill(slot, uint8_t(intervals_.latest() - 1)); }
  void touched(uint32_t slot) override { intervals_.touch(slot); }
  void emptied(uint32_t slot) override { intervals_.empty(slot); }

 private:
  Intervals intervals_;
};

const Register<Replacement, Srrip> registered;

}  // namespace
}  // namespace glint::mem
