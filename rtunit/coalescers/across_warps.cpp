// Implements the coalescer `across_warps`: all lanes in the unit that wait to ask for the same node share its
// fetch.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/coalescer.h"

namespace glint::rt {
namespace {

class AcrossWarps final : public Coalescer {
 public:
  static constexpr std::string_view kName = "across_warps";
  static constexpr std::string_view kDoc =
      "Lanes of all warps in the unit that wait to ask for the same node share a fetch.";
  struct Params {
    static ParamList params() { return {}; }
  };
  AcrossWarps(Params, Context) {}

  uint64_t partners(uint32_t, std::span<const WarpView> warps) const override {
    uint64_t ready = 0;
    for (size_t i = 0; i < warps.size(); ++i) ready |= uint64_t{warps[i].ready} << i;
    return ready;
  }
};

const Register<Coalescer, AcrossWarps> registered;

}  // namespace
}  // namespace glint::rt
