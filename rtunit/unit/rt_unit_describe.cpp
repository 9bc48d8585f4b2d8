// What an RT unit says of itself when the machine is stuck.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <fmt/format.h>

#include "rtunit/unit/rt_unit.h"

namespace glint::rt {

std::string RtUnit::describe() const {
  if (num_resident_ == 0) return {};
  std::string out = fmt::format(
      "  RT unit: {} of {} warps, {} node fetches without an answer, {} and {} and {} lanes in box, triangle "
      "and transform tests\n",
      num_resident_, slots_.size(), num_fetches_, pipes_[kBox].waiting.size() + pipes_[kBox].running.size(),
      pipes_[kTriangle].waiting.size() + pipes_[kTriangle].running.size(),
      pipes_[kTransform].waiting.size() + pipes_[kTransform].running.size());
  for (const Slot& slot : slots_)
    if (slot.used)
      out += fmt::format("    slot {} since cycle {}: {} rays, of them {} want a node and {} have stopped\n",
                         slot.warp, slot.arrived, std::popcount(slot.mask), std::popcount(slot.wanting),
                         std::popcount(slot.stopped));
  return out;
}

}  // namespace glint::rt
