// Finds the loops of a launch's programs, and those among them that nothing leads out of.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
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

// Returns text on the loops around an instruction, the innermost first: "in the loop of lines 5 to 9, which
// is in the loop of lines 3 to 12". Without source lines the text names instructions. It is empty outside of
// loops.
std::string loops_around(const Image& image, uint32_t pc);

// Names the source line where most warps of a launch are.
struct BusiestLine {
  std::string place;             // such as "path.rgen:12"
  uint32_t pc = 0;               // the first instruction of the line that a warp comes to next
  size_t num_warps = 0, of = 0;  // how many of the warps are there
  // Returns "3 of 4 running warps are at path.rgen:12", with the loops around the line.
  std::string to_string(const Image& image) const;
};
// Returns that line of warps that come to these instructions next, or nothing without warps. Of lines with as
// many warps, the one with the first instruction is named.
std::optional<BusiestLine> busiest_line(const Image& image, std::span<const uint32_t> pcs);

}  // namespace glint::exec
