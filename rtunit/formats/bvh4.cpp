// Implements the node format `bvh4`: 128-byte nodes of four boxes in single precision, as large as AMD's RDNA
// 2 box nodes.
// SPDX-License-Identifier: Apache-2.0
#include "base/registry.h"
#include "rtunit/formats/float_boxes.h"

namespace glint::rt {
namespace {

// The RDNA 2 ISA guide (2020, IMAGE_BVH_INTERSECT_RAY) describes a box node of 32-bit floats: it has four
// references, whose low 3 bits are the kind, and four boxes, in 128 B. Choice: planes of one axis lie
// together, and references lie behind the boxes. examples/policies/box32.cpp has the fields in AMD's order.
class Bvh4 final : public FloatBoxes<Bvh4, 4> {
 public:
  static constexpr std::string_view kName = "bvh4";
  static constexpr std::string_view kDoc =
      "Internal nodes have 128 B and four children, whose planes are in single precision.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Bvh4(Params, Context) {}
};
static_assert(Bvh4::kNodeBytes == 128);

const Register<NodeFormat, Bvh4> registered;

}  // namespace
}  // namespace glint::rt
