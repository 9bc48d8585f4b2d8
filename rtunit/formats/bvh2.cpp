// Implements the node format `bvh2`: 64-byte nodes of two boxes in single precision, as software traversal on
// GPUs has them.
// SPDX-License-Identifier: Apache-2.0
#include "base/registry.h"
#include "rtunit/formats/float_boxes.h"

namespace glint::rt {
namespace {

// The node of Aila and Laine 2009, "Understanding the Efficiency of Ray Traversal on GPUs", holds both
// children's boxes (48 B) and two references in 64 B. Choice: planes of one axis lie together.
class Bvh2 final : public FloatBoxes<Bvh2, 2> {
 public:
  static constexpr std::string_view kName = "bvh2";
  static constexpr std::string_view kDoc =
      "Internal nodes have 64 B and two children, whose planes are in single precision.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Bvh2(Params, Context) {}
};
static_assert(Bvh2::kNodeBytes == 64);

const Register<NodeFormat, Bvh2> registered;

}  // namespace
}  // namespace glint::rt
