// Implements the work mapping `own_ray`: a lane visits the nodes of its own ray only.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/work_mapping.h"

namespace glint::rt {
namespace {

class OwnRay final : public WorkMapping {
 public:
  static constexpr std::string_view kName = kOwnRay;
  static constexpr std::string_view kDoc = "A lane visits the nodes of its own ray only.";
  static constexpr bool kInIntervalModel = true;
  struct Params {
    static ParamList params() { return {}; }
  };
  OwnRay(Params, Context) {}
};

const Register<WorkMapping, OwnRay> registered;

}  // namespace
}  // namespace glint::rt
