// Notes the leaf filter's answers to a step, and makes lanes read what they name.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/leaf_look_ups.h"

#include <utility>

#include "base/check.h"
#include "memsys/request.h"

namespace glint::rt {

LeafLookUps::LeafLookUps(std::unique_ptr<LeafFilter> filter, WarpBuffer& buffer)
    : filter_(std::move(filter)), buffer_(buffer), reads_(buffer.size()) {
}

void LeafLookUps::entered(uint32_t slot, int lane, Cycle) {
  buffer_[slot].ray_of(lane).filter = this;
  reads_[slot][size_t(lane)].count = 0;
}

LeafAnswer LeafLookUps::look_up(const LeafQuestion& question) const {
  const LeafAnswer answer = filter_->look_up(question);
  GLINT_CHECK(num_answers_ < answers_.size(), "a step asked about more triangles than a leaf has");
  answers_[num_answers_++] = answer;
  return answer;
}

void LeafLookUps::visited(const Visit& visit) {
  Reads& reads = reads_[visit.slot][size_t(visit.lane)];
  for (uint32_t i = 0; i < num_answers_; ++i) {
    filter_->looked_up(answers_[i]);
    if (answers_[i].from) reads.from[reads.count++] = answers_[i].from;
  }
  num_answers_ = 0;
}

bool LeafLookUps::detour(uint32_t slot, int lane, Cycle) {
  Reads& reads = reads_[slot][size_t(lane)];
  if (reads.count == 0) return false;
  // Both of a leaf's triangles may have their states in one sector.
  const Address from = reads.from[--reads.count];
  if (reads.count && reads.from[0] == from) reads.count = 0;
  buffer_.want(slot, lane, {from, mem::kSectorBytes, NodeKind::Triangle}, kNoPipe, this);
  return true;
}

}  // namespace glint::rt
