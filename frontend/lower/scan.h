// Values combined over lanes: all of a warp, of clusters, of partitions, or those up to each lane.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "frontend/lower/lowering.h"

namespace glint::frontend::scan {

enum class Scope : uint8_t { All, UpToSelf, BeforeSelf };

// Which executing lanes are combined for a lane.
struct Lanes {
  Scope scope = Scope::All;
  uint32_t cluster = 32;             // lanes of a cluster, a power of two
  std::optional<Operand> partition;  // a mask: the lanes of the part that holds the lane
};

// `name32` as for typed(); `op` tells the value for no lanes, and the logical operations.
Operand combine(ModuleLowering& l, spv::Op op, std::string_view name32, Part part, const Operand& x,
                const Lanes& lanes);

// A shuffle of a value of any type; `segment` is the ISA's last operand but the mask.
Operand shuffle(ModuleLowering& l, std::string_view op, Part part, const Operand& x, const Operand& lane,
                const Operand& segment);
// The value of that lane.
Operand from_lane(ModuleLowering& l, Part part, const Operand& x, const Operand& lane);

// The number of the lowest bit that is set; -1 where none is.
Operand lowest(ModuleLowering& l, const Operand& bits);

}  // namespace glint::frontend::scan
