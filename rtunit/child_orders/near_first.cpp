// Implements the child order `near_first`: the ray visits the children by distance, as in hardware that sorts
// its hits.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/child_order.h"

namespace glint::rt {
namespace {

class NearFirst final : public ChildOrder {
 public:
  static constexpr std::string_view kName = "near_first";
  static constexpr std::string_view kDoc =
      "The nearest child comes first. Of equally near children, the one that lies first in the node comes "
      "first.";
  struct Params {
    static ParamList params() { return {}; }
  };
  NearFirst(Params, Context) {}

  void sort(const ChildHits& hits, uint8_t* order) const override { nearest_first(hits, order); }
  const ChildOrder* for_rays() const override { return nullptr; }
};

const Register<ChildOrder, NearFirst> registered;

}  // namespace
}  // namespace glint::rt
