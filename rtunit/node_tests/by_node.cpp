// Implements the node test `by_node`: a node takes one start, and a leaf of two triangles takes two.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/node_test.h"
#include "rtunit/node_tests/leaf_triangles.h"

namespace glint::rt {
namespace {

class ByNode final : public NodeTest {
 public:
  static constexpr std::string_view kName = "by_node";
  static constexpr std::string_view kDoc = "A node takes one start, and a leaf of two triangles takes two.";
  static constexpr bool kInIntervalModel = true;
  struct Params {
    static ParamList params() { return {}; }
  };
  ByNode(Params, Context context) : memory_(context.memory) {}

  uint8_t starts(const Fetch& node) const override {
    return node.kind == NodeKind::Triangle ? triangles_of(node, memory_) : 1;
  }

 private:
  const mem::AddressSpace& memory_;
};

const Register<NodeTest, ByNode> registered;

}  // namespace
}  // namespace glint::rt
