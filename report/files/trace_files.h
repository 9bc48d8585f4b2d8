// Writes a trace as the file that Perfetto and Chrome's tracing page open, and reads it for the report.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/trace_table.h"

namespace glint::report {

// Returns trace.json.gz: Chrome's trace event format, JSON object form, with an event per line. A microsecond
// of it is a cycle. The processes are: 1 the GPU, 2 + i core i, then the memory. The threads of a core are 1
// + slot, and 1001 + place of the RT unit's warp buffer; those of the memory are 1 + channel.
std::string trace_json_gz(const TraceTable& trace);

// Returns the number of events for slices and counters in a trace.
uint64_t num_events(const TraceTable& trace);

// Says which part of a trace is shown as a timeline: part of one core.
struct TimelineRequest {
  uint32_t core = 0;
  Cycle begin = 0, end = 0;  // end 0: as much around the trace's middle as fits
  size_t most_slices = 2000;
};
struct Timeline {
  struct Slice {
    uint32_t thread = 0;     // number of the thread in the file
    std::string kind, name;  // "warp", "stage", "state", "rays"
    Cycle begin = 0, length = 0;
    std::map<std::string, uint64_t> args;
  };
  uint32_t core = 0, cores = 0;
  Cycle begin = 0, end = 0, trace_begin = 0, trace_end = 0;
  bool is_cut = false;  // it ends at the limit of slices, before the end of the wanted window
  // The slices are ordered by begin, outer slices before inner ones, and cut at the window's ends.
  std::vector<Slice> slices;
};

// Reads a file that trace_json_gz() wrote. Throws UserError when there is no such core or window, or when the
// file is something else.
Timeline read_timeline(const std::string& path, const TimelineRequest& request);

}  // namespace glint::report
