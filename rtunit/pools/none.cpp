// Implements the ray pool `none`: warps stay in the RT unit as the core gave them.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/ray_pool.h"

namespace glint::rt {
namespace {

class NoPool final : public RayPool {
 public:
  static constexpr std::string_view kName = kNone;
  static constexpr std::string_view kDoc = "Warps stay as the core gave them.";
  static constexpr bool kInIntervalModel = true;
  struct Params {
    static ParamList params() { return {}; }
  };
  NoPool(Params, Context) {}
};

const Register<RayPool, NoPool> registered;

}  // namespace
}  // namespace glint::rt
