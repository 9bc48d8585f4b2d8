// Notes when a memory channel has requests, as slices of a trace, within a window and a bound.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/trace_table.h"
#include "memsys/partition.h"

namespace glint::pipeline {

// As core::TraceRecorder: slices are cut at the window's ends, which comes earlier where the bound is reached.
class ChannelRecorder {
 public:
  // `room`: slices, at least one. Nothing is allocated later.
  ChannelRecorder(uint32_t channel, Cycle begin, Cycle end, uint64_t room) : channel_(channel), begin_(begin), end_(end) { slices_.reserve(room); }

  void turn(const mem::DramTurn& to) {
    if (to.works) {
      since_ = to;
      // Its request is taken in the cycle in which it begins.
      since_.requests = last_requests_;
      if (slices_.size() == slices_.capacity()) end_ = std::min(end_, to.cycle);
    } else if (since_.works) {
      last_requests_ = to.requests;
      if (since_.cycle < end_ && to.cycle > begin_)
        slices_.push_back({std::max(since_.cycle, begin_), std::min(to.cycle, end_), channel_, TraceKind::Channel, uint32_t(to.requests - since_.requests), {}});
      since_.works = false;
    }
  }
  void finish(Cycle end, uint64_t requests) { turn({end, false, requests}); }

  Cycle end() const { return end_; }
  const std::vector<TraceSlice>& slices() const { return slices_; }

 private:
  const uint32_t channel_;
  const Cycle begin_;
  Cycle end_;
  mem::DramTurn since_;
  uint64_t last_requests_ = 0;
  std::vector<TraceSlice> slices_;
};

}  // namespace glint::pipeline
