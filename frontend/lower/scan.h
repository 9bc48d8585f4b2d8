// Combines values over lanes: all lanes of a warp, of a cluster or of a partition, or those up to each lane.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "frontend/lower/lowering.h"

namespace glint::frontend::scan {

enum class Scope : uint8_t { All, UpToSelf, BeforeSelf };

// Says which executing lanes are combined for a lane.
struct Lanes {
  Scope scope = Scope::All;
  uint32_t cluster = 32;             // lanes of a cluster, a power of two
  std::optional<Operand> partition;  // mask of the lanes in the same part as the lane
};

// Combines `x` over lanes. `name32` is a name for typed(); `op` gives the value for no lanes, and selects
// logical operations.
Operand combine(ModuleLowering& l, spv::Op op, std::string_view name32, Part part, const Operand& x,
                const Lanes& lanes);

// Shuffles a value of any type. `segment` is the ISA's operand before the mask.
Operand shuffle(ModuleLowering& l, std::string_view op, Part part, const Operand& x, const Operand& lane,
                const Operand& segment);
// Returns the value of that lane.
Operand from_lane(ModuleLowering& l, Part part, const Operand& x, const Operand& lane);

// Returns the number of the lowest set bit, or -1 where none is set.
Operand lowest(ModuleLowering& l, const Operand& bits);

}  // namespace glint::frontend::scan
