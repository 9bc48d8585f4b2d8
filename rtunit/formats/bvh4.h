// Defines the node format `bvh4`: 128-byte nodes of four boxes in single precision, as large as AMD's RDNA 2
// box nodes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "rtunit/formats/float_boxes.h"

namespace glint::rt {

// The RDNA 2 ISA guide (2020, IMAGE_BVH_INTERSECT_RAY) describes a box node of 32-bit floats: it has four
// references, whose low 3 bits are the kind, and four boxes, in 128 B. Choice: planes of one axis lie
// together, and references lie behind the boxes.
using Bvh4 = FloatBoxes<4>;
static_assert(Bvh4::kNodeBytes == 128);

}  // namespace glint::rt
