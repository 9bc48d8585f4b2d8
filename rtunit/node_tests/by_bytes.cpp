// Implements the node test `by_bytes`: a node takes as many starts as its bytes and its triangles need.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "rtunit/node_test.h"
#include "rtunit/node_tests/leaf_triangles.h"

namespace glint::rt {
namespace {

// Units are built for so many boxes or triangles at once, so wide nodes take longer than narrow ones. Vendors
// publish rates: AMD's RDNA 3 tests 4 boxes (128 B as floats) or 1 triangle a cycle, RDNA 4 8 boxes (128 B)
// or 2 triangles.
class ByBytes final : public NodeTest {
 public:
  static constexpr std::string_view kName = "by_bytes";
  static constexpr std::string_view kDoc = "A node takes as many starts as its bytes and its triangles need.";
  struct Params {
    uint32_t box_bytes = 64;  // Choice: as many as the node of `bvh6`, which then takes one start
    uint32_t triangles = 1;
    static ParamList params() {
      return {param(&Params::box_bytes, "box_bytes", "byte",
                    "Number of bytes of an internal node that one start tests.", 8, 4096),
              param(&Params::triangles, "triangles", "triangle",
                    "Number of triangles of a leaf that one start tests.", 1, 2)};
    }
  };
  ByBytes(Params params, Context context) : params_(params), memory_(context.memory) {}

  uint8_t starts(const Fetch& node) const override {
    if (node.kind == NodeKind::Internal)
      return uint8_t((node.bytes + params_.box_bytes - 1) / params_.box_bytes);
    if (node.kind != NodeKind::Triangle || params_.triangles > 1) return 1;
    return triangles_of(node, memory_);
  }

 private:
  const Params params_;
  const mem::AddressSpace& memory_;
};

const Register<NodeTest, ByBytes> registered;

}  // namespace
}  // namespace glint::rt
