// Runs image ops of the lanes of a warp: textures, surfaces, and queries of images.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "exec/bound_images.h"
#include "exec/surface_ops.h"
#include "exec/texel_list.h"
#include "exec/texture_ops.h"

namespace glint::exec {

class ImageOps {
 public:
  ImageOps(const World& world, FaultGate& faults, SeenMemory& seen)
      : seen_(seen),
        images_(world, faults),
        textures_(world, faults, seen, images_, texels_),
        surfaces_(world, faults, seen, images_, texels_) {}

  // Returns false after a fault.
  bool run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  // Returns the texels that the last op touched, or none when it needed no memory.
  const TexelList& texels() const { return texels_; }
  const NotFiniteStores& not_finite_stores() const { return surfaces_.not_finite_stores(); }

 private:
  SeenMemory& seen_;
  TexelList texels_;
  BoundImages images_;
  TextureOps textures_;
  SurfaceOps surfaces_;
};

}  // namespace glint::exec
