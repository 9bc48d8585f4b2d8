// Defines the node format `bvh2`: 64-byte nodes of two boxes in single precision, as software traversal on
// GPUs has them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "rtunit/formats/float_boxes.h"

namespace glint::rt {

// The node of Aila and Laine 2009, "Understanding the Efficiency of Ray Traversal on GPUs", holds both
// children's boxes (48 B) and two references in 64 B. Choice: planes of one axis lie together.
using Bvh2 = FloatBoxes<2>;
static_assert(Bvh2::kNodeBytes == 64);

}  // namespace glint::rt
