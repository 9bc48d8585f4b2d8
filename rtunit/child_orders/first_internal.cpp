// Implements the child order `first_internal`: the ray goes down the first internal child and visits the
// others from the last to the first, as in Vulkan-Sim 2.0.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/child_order.h"

namespace glint::rt {
namespace {

class FirstInternal final : public ChildOrder {
 public:
  static constexpr std::string_view kName = "first_internal";
  static constexpr std::string_view kDoc =
      "The first internal child that is hit comes first. The other children follow from the last to the "
      "first, as in Vulkan-Sim.";
  struct Params {
    static ParamList params() { return {}; }
  };
  FirstInternal(Params, Context) {}

  // Vulkan-Sim goes on with the first internal child and pushes the others in index order
  // (vulkan_ray_tracing.cc, traceRay).
  void sort(const ChildHits& hits, uint8_t* order) const override {
    int first = 0;
    while (first < hits.count && kind_of(hits.child[first]) != NodeKind::Internal) ++first;
    int at = 0;
    if (first < hits.count) order[at++] = uint8_t(first);
    for (int i = hits.count - 1; i >= 0; --i)
      if (i != first) order[at++] = uint8_t(i);
  }
};

const Register<ChildOrder, FirstInternal> registered;

}  // namespace
}  // namespace glint::rt
