// Describes an RT unit when the machine is stuck.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "base/num_lanes.h"
#include "rtunit/unit/rt_unit.h"

namespace glint::rt {

std::string RtUnit::describe() const {
  if (num_resident() == 0) return {};
  std::string out = fmt::format(
      "  RT unit: {} of {} warps, {} node fetches without an answer, {} and {} and {} lanes in box, triangle "
      "and transform tests\n",
      num_resident(), buffer_.size(), fetches_.num_reads(), pipelines_.num_tests(kBoxPipe),
      pipelines_.num_tests(kTrianglePipe), pipelines_.num_tests(kTransformPipe));
  for (uint32_t i = 0; i < buffer_.size(); ++i) {
    const BufferSlot& slot = buffer_[i];
    if (slot.is_used)
      out += fmt::format("    slot {} since cycle {}: {} rays, of them {} want a node and {} have stopped\n",
                         slot.warp_slot, slot.arrived, num_lanes(slot.mask), num_lanes(slot.wanting),
                         num_lanes(slot.stopped));
  }
  return out;
}

}  // namespace glint::rt
