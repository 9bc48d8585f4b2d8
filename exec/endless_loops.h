// Finds the loops of a launch's programs, and those among them that nothing leads out of.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "exec/fault.h"
#include "exec/image.h"
#include "exec/warp_context.h"

namespace glint::exec {

// Knows the instructions of loops from which no lane ever comes to its end: no path leads from them to an
// exit, a return or a trap. A warp that has come to one runs for ever.
class EndlessLoops {
 public:
  explicit EndlessLoops(const Image& image);

  bool any() const { return !is_in_.empty(); }
  bool holds(uint32_t pc) const { return any() && is_in_[pc]; }
  // Returns the fault of a warp that is in such a loop. The place is where the loop begins.
  Fault fault(const World& world, const WarpContext& warp) const;

 private:
  std::vector<uint8_t> is_in_;  // one per instruction; empty when there are none
};

// Returns text on the loops around an instruction, the innermost first: "it is in the loop of lines 5 to 9,
// and that is in the loop of lines 3 to 12". Without source lines the text names instructions. It is empty
// outside of loops.
std::string loops_around(const Image& image, uint32_t pc);

// Says where warps are that come to these instructions next: the line where most of them are, how many these
// are, and the loops around it. It is empty without warps. Of lines with as many warps, the one with the
// first instruction is named.
std::string whereabouts(const Image& image, std::span<const uint32_t> pcs);

}  // namespace glint::exec
