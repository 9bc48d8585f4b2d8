// Finds the images and samplers that a launch has bound, by their handles.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "exec/fault_gate.h"
#include "isa/op_row.h"

namespace glint::exec {

class BoundImages {
 public:
  BoundImages(const World& world, FaultGate& faults) : world_(world), faults_(faults) {}

  // Returns the image of a lane's handle. Null says that there is none that the op can use. That is a fault,
  // or it was let pass, or the image is null on purpose (FaultGate::fault() is then not set).
  const ImageView* find(const WarpContext& warp, const isa::OpRow& row, int lane);
  const Sampler& sampler_of(const ImageView& image, Address handle) const;
  // Returns the format of the image of a lane's handle.
  TexelFormat format_of(const WarpContext& warp, int lane) const {
    return world_.image_at(warp.regs.access.address[size_t(lane)] % (1u << isa::kHandleSamplerShift)).format;
  }

 private:
  const World& world_;
  FaultGate& faults_;
};

}  // namespace glint::exec
