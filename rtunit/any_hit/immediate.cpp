// Implements the any-hit mode `immediate`: a ray stops at each candidate, the shader runs, and the ray goes
// on. It is shorter when the candidate was accepted.
// SPDX-License-Identifier: Apache-2.0

#include "base/check.h"
#include "base/registry.h"
#include "rtunit/any_hit_mode.h"

namespace glint::rt {
namespace {

class Immediate final : public AnyHitMode {
 public:
  static constexpr std::string_view kName = "immediate";
  static constexpr std::string_view kDoc = "A ray stops at each candidate until its shader has run.";
  static constexpr bool kInIntervalModel = true;
  struct Params {
    static ParamList params() { return {}; }
  };
  Immediate(Params, Context) {}

  uint32_t table_rows() const override { return 0; }
  void present(RayState*, LaneMask, const ShaderOf&) const override {
    GLINT_PANIC("mode '{}' has no tables", kName);
  }
};

const Register<AnyHitMode, Immediate> registered;

}  // namespace
}  // namespace glint::rt
