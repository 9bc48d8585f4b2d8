// Implements the child order `index_order`: the ray visits the children as they lie in the node, for a unit
// that cannot sort.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/child_order.h"

namespace glint::rt {
namespace {

class IndexOrder final : public ChildOrder {
 public:
  static constexpr std::string_view kName = "index_order";
  static constexpr std::string_view kDoc =
      "The children follow each other as they lie in the node, whatever their distance.";
  struct Params {
    static ParamList params() { return {}; }
  };
  IndexOrder(Params, Context) {}

  void sort(const ChildHits& hits, uint8_t* order) const override {
    for (int i = 0; i < hits.count; ++i) order[i] = uint8_t(i);
  }
};

const Register<ChildOrder, IndexOrder> registered;

}  // namespace
}  // namespace glint::rt
