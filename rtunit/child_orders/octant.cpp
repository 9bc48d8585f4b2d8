// Implements the child order `octant`: the signs of a ray's direction say in which order it visits the slots
// of a node.
// SPDX-License-Identifier: Apache-2.0
#include "base/registry.h"
#include "rtunit/child_order.h"

namespace glint::rt {
namespace {

// Ylitie, Karras and Laine 2017 compare no distances, so hardware needs no sorter.
class OctantOrder final : public ChildOrder {
 public:
  static constexpr std::string_view kName = "octant";
  static constexpr std::string_view kDoc =
      "The signs of the ray's direction give the order of the children's slots. Nothing is sorted, and the "
      "node format must place the children by octant, as cwbvh does.";
  struct Params {
    static ParamList params() { return {}; }
  };
  OctantOrder(Params, Context) {}

  bool needs_octant_slots() const override { return true; }
  void sort(const ChildHits& hits, uint8_t* order) const override {
    for (int i = 0; i < hits.count; ++i) {
      int at = i;
      for (; at > 0 && key(hits, i) < key(hits, order[at - 1]); --at) order[at] = order[at - 1];
      order[at] = uint8_t(i);
    }
  }

 private:
  static uint32_t key(const ChildHits& hits, int i) { return hits.slot[i] ^ hits.octant; }
};

const Register<ChildOrder, OctantOrder> registered;

}  // namespace
}  // namespace glint::rt
