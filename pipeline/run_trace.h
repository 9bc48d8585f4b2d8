// Traces a timing run: warps, RT units and counters within a window of cycles.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "base/trace_table.h"
#include "core/trace_recorder.h"
#include "pipeline/channel_recorder.h"
#include "pipeline/trace_request.h"

namespace glint::pipeline {

class TimingMachine;

struct TraceRecorders {
  std::vector<std::unique_ptr<core::TraceRecorder>> cores;
  std::vector<std::unique_ptr<ChannelRecorder>> channels;
};

// Watches the machine's cores, RT units and memory channels; it is called before the run. The caller keeps
// the recorders until the run is over. Each core has an equal part of the limit less what counters and
// channels may take. Throws UserError when that is less than its tracks need.
TraceRecorders record_trace(TimingMachine& machine, const exec::Image& image, const TraceRequest& request);

// Returns the trace after the run, whose counters were sampled every `interval` cycles. The trace ends for
// all units where the first of them had no more room.
TraceTable trace_of(TimingMachine& machine, const exec::Image& image, const TraceRequest& request,
                    const TraceRecorders& recorders, Cycle interval);

}  // namespace glint::pipeline
