// Notes when a memory channel has requests, as slices of a trace, within a window and a bound.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/trace_table.h"
#include "memsys/partition.h"

namespace glint::pipeline {

// Works as core::TraceRecorder: slices are cut at the window's ends, and the window ends earlier when the
// bound is reached.
class ChannelRecorder {
 public:
  // `room` is the number of slices, at least one. Nothing is allocated later.
  ChannelRecorder(uint32_t channel, Cycle begin, Cycle end, uint64_t room)
      : channel_(channel), begin_(begin), end_(end) {
    slices_.reserve(room);
  }

  void turn(const mem::DramTurn& to) {
    if (to.works) {
      since_ = to.cycle;
      if (slices_.size() == slices_.capacity()) end_ = std::min(end_, to.cycle);
    } else if (works_) {
      if (since_ < end_ && to.cycle > begin_)
        slices_.push_back({std::max(since_, begin_),
                           std::min(to.cycle, end_),
                           channel_,
                           TraceKind::Channel,
                           uint32_t(to.requests - told_),
                           {}});
      told_ = to.requests;
    }
    works_ = to.works;
  }
  void finish(Cycle end, uint64_t requests) { turn({end, false, requests}); }

  Cycle end() const { return end_; }
  const std::vector<TraceSlice>& slices() const { return slices_; }

 private:
  const uint32_t channel_;
  const Cycle begin_;
  Cycle end_;
  bool works_ = false;
  Cycle since_ = 0;    // the start of the present work, while the channel works
  uint64_t told_ = 0;  // requests that are in slices so far, or came before the window
  std::vector<TraceSlice> slices_;
};

}  // namespace glint::pipeline
