// Holds the trace of a window of a timing run: who was where and when, and counters by interval.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/types.h"

namespace glint {

// Names what a slice shows. On the track of a warp slot, Stages lie within a Warp and States within a Stage,
// without gaps.
enum class TraceKind : uint8_t {
  Warp,     // a warp holds a warp slot. value: the warp's number in the launch
  Stage,    // a warp executes one shader. value: index into TraceTable::shaders
  State,    // a warp is in one state. value: index into TraceTable::states; 0 is running
  Rays,     // a warp is in the RT unit. value: rays; args: warp slot, nodes visited, triangle tests
  Channel,  // a memory channel has requests. value: requests that it accepted meanwhile
};

// Covers the cycles [begin, end) of one core or memory channel.
struct TraceSlice {
  Cycle begin = 0, end = 0;
  uint32_t place = 0;  // warp slot, or entry of the RT unit's warp buffer
  TraceKind kind = TraceKind::Warp;
  uint32_t value = 0;
  uint32_t args[3] = {};
};

// Holds a number of the whole GPU, a core or a memory channel for each interval, which starts at `cycle`.
struct TraceCounter {
  enum class Of : uint8_t { Gpu, Core, Channel } of = Of::Gpu;
  uint32_t index = 0;  // number of the core or channel
  std::string name, unit;
  std::vector<std::pair<Cycle, double>> values;
};

struct TraceTable {
  Cycle begin = 0, end = 0;        // cycles that the trace shows
  Cycle asked_end = 0;             // requested end; later than `end` when the limit cut the trace
  uint64_t limit = 0;              // maximum number of events
  uint32_t counters_left_out = 0;  // counters that had no room
  std::vector<std::string> shaders, stages, states;  // each shader has a stage
  std::vector<std::vector<TraceSlice>> cores, channels;
  std::vector<TraceCounter> counters;

  bool is_cut() const { return end < asked_end; }
};

}  // namespace glint
