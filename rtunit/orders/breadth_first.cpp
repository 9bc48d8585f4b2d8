// Implements the traversal order `breadth_first`: a ray visits the oldest of its open nodes.
// SPDX-License-Identifier: Apache-2.0
#include "base/registry.h"
#include "rtunit/traversal_order.h"

namespace glint::rt {
namespace {

// Model: each structure is walked by levels of its own, so an instance is walked to its end before the other
// nodes of the top level.
class BreadthFirstOrder final : public TraversalOrder {
 public:
  static constexpr std::string_view kName = "breadth_first";
  static constexpr std::string_view kDoc = "A ray visits the nodes of a level before those of the next one.";
  struct Params {
    static ParamList params() { return {}; }
  };
  BreadthFirstOrder(Params, const Context&) {}

  void arrange(const OpenNodes& open) override {
    move_below(open.ray.stack, open.bottom, open.first, open.end);
  }
};

const Register<TraversalOrder, BreadthFirstOrder> registered;

}  // namespace
}  // namespace glint::rt
