// Implements the prefetcher `none`: nothing is read before a ray asks for it.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/prefetcher.h"

namespace glint::rt {
namespace {

class None final : public Prefetcher {
 public:
  static constexpr std::string_view kName = kNone;
  static constexpr std::string_view kDoc = "Nothing is read before a ray asks for it.";
  static constexpr bool kInIntervalModel = true;
  struct Params {
    static ParamList params() { return {}; }
  };
  None(Params, Context) {}
};

const Register<Prefetcher, None> registered;

}  // namespace
}  // namespace glint::rt
