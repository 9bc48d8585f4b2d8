// Implements the interleaving `none`: a path of a warp runs until it ends or meets the others.
// SPDX-License-Identifier: Apache-2.0
#include "core/interleaving.h"

namespace glint::core {
namespace {

class NoInterleaving final : public Interleaving {
 public:
  static constexpr std::string_view kName = "none";
  static constexpr std::string_view kDoc =
      "A path of a warp runs until it ends or its lanes meet the others.";
  static constexpr bool kInIntervalModel = true;
  struct Params {
    static ParamList params() { return {}; }
  };
  NoInterleaving(Params, Context) {}
  bool is_used() const override { return false; }
  bool leaves(const View&) const override { return false; }
};

const Register<Interleaving, NoInterleaving> registered;

}  // namespace
}  // namespace glint::core
