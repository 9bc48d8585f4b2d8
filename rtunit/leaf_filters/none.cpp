// Implements the leaf filter `none`: shaders decide all candidates that are not opaque.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/leaf_filter.h"

namespace glint::rt {
namespace {

class NoFilter final : public LeafFilter {
 public:
  static constexpr std::string_view kName = kNone;
  static constexpr std::string_view kDoc = "Any-hit shaders decide all candidates that are not opaque.";
  static constexpr bool kInIntervalModel = true;
  struct Params {
    static ParamList params() { return {}; }
  };
  NoFilter(Params, Context) {}
};

const Register<LeafFilter, NoFilter> registered;

}  // namespace
}  // namespace glint::rt
