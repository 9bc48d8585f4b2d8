// Implements the stack model `full`: every entry of a ray is on chip.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/stack_model.h"

namespace glint::rt {
namespace {

class Full final : public StackModel {
 public:
  static constexpr std::string_view kName = "full";
  static constexpr std::string_view kDoc = "A ray keeps every entry on chip.";
  static constexpr bool kInIntervalModel = true;
  struct Params {
    static ParamList params() { return {}; }
  };
  Full(Params, Context) {}

  StackWork settle(RayState&) const override { return {}; }
};

const Register<StackModel, Full> registered;

}  // namespace
}  // namespace glint::rt
