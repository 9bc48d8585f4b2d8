// Implements the coalescer `within_warp`: lanes of one warp that want the same node share its fetch, as in
// the published simulators.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/coalescer.h"

namespace glint::rt {
namespace {

class WithinWarp final : public Coalescer {
 public:
  static constexpr std::string_view kName = "within_warp";
  static constexpr std::string_view kDoc = "Lanes of one warp that want the same node share a fetch.";
  static constexpr bool kInIntervalModel = true;
  struct Params {
    static ParamList params() { return {}; }
  };
  WithinWarp(Params, Context) {}

  uint64_t partners(uint32_t picked, std::span<const WarpView>) const override {
    return uint64_t{1} << picked;
  }
};

const Register<Coalescer, WithinWarp> registered;

}  // namespace
}  // namespace glint::rt
