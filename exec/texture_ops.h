// Runs texture ops: samples, gathers and fetches of the lanes of a warp, and queries of images.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "exec/bound_images.h"
#include "exec/seen_memory.h"
#include "exec/texel_list.h"

namespace glint::exec {

// Runs texture ops. Each function returns false after a fault.
class TextureOps {
 public:
  // `texels` is the list that receives what an op touches.
  TextureOps(const World& world, FaultGate& faults, SeenMemory& seen, BoundImages& images, TexelList& texels)
      : world_(world), faults_(faults), seen_(seen), images_(images), texels_(texels) {}

  bool read(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  bool query(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);

 private:
  const World& world_;
  FaultGate& faults_;
  SeenMemory& seen_;
  BoundImages& images_;
  TexelList& texels_;
};

}  // namespace glint::exec
