// Implements the child order `largest_first`: a ray that may end at any hit visits the largest box first.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>

#include "base/registry.h"
#include "rtunit/child_order.h"
#include "rtunit/node_format.h"
#include "rtunit/structure/tree.h"

namespace glint::rt {
namespace {

// Nah and Manocha, "SATO: Surface Area Traversal Order for Shadow Ray Tracing", Computer Graphics Forum 33
// (6), 2014, visit the child with the larger surface area first, because an occluder is found sooner there.
// Model: The paper stores an order in each node when the structure is built. The unit computes areas from the
// boxes of the node, which takes no time here and gives the same order in nodes of two children. Choice: Of
// equal areas, the nearer child comes first, and of equally near ones the one that lies first in the node.
class LargestFirst final : public ChildOrder {
 public:
  static constexpr std::string_view kName = "largest_first";
  static constexpr std::string_view kDoc =
      "The child with the largest surface area comes first for rays that end at the first hit that is found. "
      "For other rays, the nearest child comes first.";
  struct Params {
    static ParamList params() { return {}; }
  };
  LargestFirst(Params, Context) {}

  void sort(const ChildHits& hits, uint8_t* order) const override {
    if (!hits.ray->ends_at_first_hit) return nearest_first(hits, order);
    Bounds box[kMaxWidth];
    hits.boxes(box);
    double area[kMaxWidth];
    for (int i = 0; i < hits.count; ++i) area[i] = half_area(box[i]);
    for (int i = 0; i < hits.count; ++i) {
      int at = i;
      for (; at > 0 && comes_before(hits, area, i, order[at - 1]); --at) order[at] = order[at - 1];
      order[at] = uint8_t(i);
    }
  }

 private:
  static bool comes_before(const ChildHits& hits, const double* area, int a, int b) {
    return area[a] != area[b] ? area[a] > area[b] : hits.t_enter[a] < hits.t_enter[b];
  }
};

const Register<ChildOrder, LargestFirst> registered;

}  // namespace
}  // namespace glint::rt
