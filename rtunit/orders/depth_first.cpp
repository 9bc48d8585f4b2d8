// Implements the traversal order `depth_first`: a ray visits the newest of its open nodes.
// SPDX-License-Identifier: Apache-2.0
#include "base/registry.h"
#include "rtunit/traversal_order.h"

namespace glint::rt {
namespace {

class DepthFirstOrder final : public TraversalOrder {
 public:
  static constexpr std::string_view kName = kDepthFirst;
  static constexpr std::string_view kDoc = "A ray visits what is below a node before the node's siblings.";
  static constexpr bool kInIntervalModel = true;
  struct Params {
    static ParamList params() { return {}; }
  };
  DepthFirstOrder(Params, const Context&) {}
};

const Register<TraversalOrder, DepthFirstOrder> registered;

}  // namespace
}  // namespace glint::rt
