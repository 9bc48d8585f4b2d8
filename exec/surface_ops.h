// Runs surface ops of a warp's lanes: loads, stores and atomics of single texels, or of bytes of a row.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>

#include "exec/bound_images.h"
#include "exec/not_finite_stores.h"
#include "exec/seen_memory.h"
#include "exec/texel_list.h"

namespace glint::exec {

class SurfaceOps {
 public:
  // `texels` is the list that receives what an op touches.
  SurfaceOps(const World& world, FaultGate& faults, SeenMemory& seen, BoundImages& images, TexelList& texels)
      : world_(world), faults_(faults), seen_(seen), images_(images), texels_(texels) {}

  // Returns false after a fault.
  bool run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row);
  // Returns the stores of texels that were not finite.
  const NotFiniteStores& not_finite_stores() const { return not_finite_; }

 private:
  void note_not_finite(const WarpContext& warp, int lane, TexelFormat format, const std::byte* stored);
  Words nowhere(const WarpContext& warp, const isa::OpRow& row, int lane) const;
  std::byte* find_texel(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, int lane);
  void run_seen(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row, const LanePlaces& place);

  const World& world_;
  FaultGate& faults_;
  SeenMemory& seen_;
  BoundImages& images_;
  TexelList& texels_;
  NotFiniteStores not_finite_;
  LaneMask outside_ = 0;  // lanes of the last op that were outside of an image with robust access
};

}  // namespace glint::exec
