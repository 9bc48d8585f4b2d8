// Implements the entry `root`: every ray begins at the root.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/ray_entry.h"

namespace glint::rt {
namespace {

class Root final : public RayEntry {
 public:
  static constexpr std::string_view kName = kRoot;
  static constexpr std::string_view kDoc = "A ray begins at the root.";
  static constexpr bool kInIntervalModel = true;
  struct Params {
    static ParamList params() { return {}; }
  };
  Root(Params, Context) {}
};

const Register<RayEntry, Root> registered;

}  // namespace
}  // namespace glint::rt
