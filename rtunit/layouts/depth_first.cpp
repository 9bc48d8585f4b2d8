// Implements the tree layout `depth_first`: nodes lie as a depth-first walk meets them.
// SPDX-License-Identifier: Apache-2.0
#include "base/registry.h"
#include "rtunit/tree_layout.h"

namespace glint::rt {
namespace {

class DepthFirstLayout final : public TreeLayout {
 public:
  static constexpr std::string_view kName = "depth_first";
  static constexpr std::string_view kDoc =
      "Siblings lie together, and what is below the first of them comes next. There are no treelets.";
  struct Params {
    static ParamList params() { return {}; }
  };
  DepthFirstLayout(Params, Context) {}

  NodeOrder order(const BuildTree&, uint32_t) const override { return {}; }
};

const Register<TreeLayout, DepthFirstLayout> registered;

}  // namespace
}  // namespace glint::rt
