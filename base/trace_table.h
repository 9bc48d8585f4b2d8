// What a trace tells of a window of a timing run: who was where and when, and counters by interval.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/types.h"

namespace glint {

// What a slice is of. On the track of a warp slot a Warp holds Stages, and a Stage holds States, without
// gaps.
enum class TraceKind : uint8_t {
  Warp,     // holds a warp slot. value: its number in the launch
  Stage,    // instructions of one shader. value: TraceTable::shaders
  State,    // value: TraceTable::states; 0 is running
  Rays,     // a warp's stay in the RT unit. value: rays; args: warp slot, nodes visited, triangle tests
  Channel,  // a memory channel has requests. value: those that it took meanwhile
};

// Cycles [begin, end) of one core or memory channel.
struct TraceSlice {
  Cycle begin = 0, end = 0;
  uint32_t place = 0;  // warp slot, or place in the RT unit's warp buffer
  TraceKind kind = TraceKind::Warp;
  uint32_t value = 0;
  uint32_t args[3] = {};
};

// A number of the whole GPU, a core or a memory channel, for each interval from `cycle` on.
struct TraceCounter {
  enum class Of : uint8_t { Gpu, Core, Channel } of = Of::Gpu;
  uint32_t index = 0;  // of the core or channel
  std::string name, unit;
  std::vector<std::pair<Cycle, double>> values;
};

struct TraceTable {
  Cycle begin = 0, end = 0;        // what it shows
  Cycle asked_end = 0;             // it was to show; later than `end` where the limit ended it
  uint64_t limit = 0;              // of events
  uint32_t counters_left_out = 0;  // that had no room
  std::vector<std::string> shaders, stages, states;  // a stage for each shader
  std::vector<std::vector<TraceSlice>> cores, channels;
  std::vector<TraceCounter> counters;

  bool is_cut() const { return end < asked_end; }
};

}  // namespace glint
