// Connects recorders to the units of a machine, and puts together what they noted.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/run_trace.h"

#include <algorithm>
#include <fmt/format.h>
#include <tuple>

#include "base/diagnostics.h"
#include "pipeline/run_profile.h"
#include "pipeline/timing_machine.h"

namespace glint::pipeline {
namespace {

// Choice: counters may take a quarter of the limit and slices of memory channels an eighth; those of cores
// get the rest.
uint64_t counter_room(const TraceRequest& request) {
  return request.limit / 4;
}
uint64_t channel_room(const TraceRequest& request) {
  return request.limit / 8;
}

// Returns the slices of a core up to the end of the trace. Each track is ordered from the outside in and from
// left to right.
std::vector<TraceSlice> sorted(const std::vector<TraceSlice>& slices, Cycle end) {
  std::vector<TraceSlice> out;
  for (TraceSlice slice : slices) {
    slice.end = std::min(slice.end, end);
    if (slice.begin < slice.end) out.push_back(slice);
  }
  const auto key = [](const TraceSlice& s) {
    return std::tuple(s.kind == TraceKind::Rays, s.place, s.begin, s.kind);
  };
  std::sort(out.begin(), out.end(),
            [&](const TraceSlice& a, const TraceSlice& b) { return key(a) < key(b); });
  return out;
}

// Returns a counter over the intervals of the window. `of` gives its value in the interval of sample s.
template <class Of>
TraceCounter counter(TraceCounter::Of whose, uint32_t index, const char* name, const char* unit,
                     const TraceTable& table, size_t samples, Cycle interval, Of&& of) {
  TraceCounter out{whose, index, name, unit, {}};
  for (size_t s = 0; s < samples; ++s) {
    const Cycle begin = s * interval;
    if (begin < table.begin || begin >= table.end) continue;
    out.values.emplace_back(begin, of(s));
  }
  return out;
}

// Returns the counters of all cores and channels together, then those of each.
std::vector<TraceCounter> counters_of(TimingMachine& machine, const TraceTable& table, Cycle interval) {
  using Of = TraceCounter::Of;
  std::vector<const UnitSamples*> cores, channels;
  for (uint32_t i = 0; i < machine.num_cores(); ++i) cores.push_back(&machine.core(i).sampler().samples());
  for (uint32_t i = 0; i < machine.memory().num_partitions(); ++i)
    channels.push_back(&machine.memory().partition(i).sampler().samples());
  const size_t samples = cores[0]->size();
  const Cycle last = machine.attributed_cycles();
  const auto cycles = [=](size_t s) {
    return double(std::min<Cycle>((s + 1) * interval, last) - s * interval);
  };
  std::vector<TraceCounter> out;
  const auto of_cores = [&](Of whose, uint32_t index, const std::vector<const UnitSamples*>& which) {
    const auto add = [&](const char* name, const char* unit, auto&& of) {
      out.push_back(counter(whose, index, name, unit, table, samples, interval, of));
    };
    add("IPC", "instruction/cycle", [=](size_t s) { return growth(which, s, kInstructions) / cycles(s); });
    add("warps in RT", "warp", [=](size_t s) { return growth(which, s, kRtWarps) / cycles(s); });
    add("L1 reads not hit", "fraction", [=](size_t s) {
      return 1.0 - ratio(growth(which, s, kL1Hits), growth(which, s, kL1Reads)) -
             (growth(which, s, kL1Reads) > 0 ? 0.0 : 1.0);
    });
  };
  const auto of_channels = [&](Of whose, uint32_t index, const std::vector<const UnitSamples*>& which) {
    out.push_back(counter(whose, index, "DRAM use", "fraction", table, samples, interval, [=](size_t s) {
      return ratio(growth(which, s, kDramBusy), growth(which, s, kDramClocks));
    }));
  };
  of_cores(Of::Gpu, 0, cores);
  of_channels(Of::Gpu, 0, channels);
  for (uint32_t i = 0; i < channels.size(); ++i) of_channels(Of::Channel, i, {channels[i]});
  for (uint32_t i = 0; i < cores.size(); ++i) of_cores(Of::Core, i, {cores[i]});
  return out;
}

// Leaves out counters that have no room, from the end.
void keep_within(TraceTable& table, uint64_t room) {
  uint64_t events = 0;
  size_t kept = 0;
  for (; kept < table.counters.size() && events + table.counters[kept].values.size() <= room; ++kept)
    events += table.counters[kept].values.size();
  table.counters_left_out = uint32_t(table.counters.size() - kept);
  table.counters.resize(kept);
}

}  // namespace

TraceRecorders record_trace(TimingMachine& machine, const exec::Image& image, const TraceRequest& request) {
  TraceRecorders recorders;
  const uint32_t cores = machine.num_cores(), places = rt::RtUnit::places(machine.params().rt),
                 slots = machine.core(0).num_slots();
  const uint64_t room = (request.limit - counter_room(request) - channel_room(request)) / cores,
                 least = core::TraceRecorder::least_room(slots, places) + 1;
  if (room < least)
    throw UserError(
        {}, fmt::format("--trace-limit {} is too small for the tracks of {} cores", request.limit, cores),
        fmt::format("give at least {}", least * cores * 8 / 5 + 8));
  for (uint32_t i = 0; i < cores; ++i) {
    recorders.cores.push_back(
        std::make_unique<core::TraceRecorder>(image, slots, places, request.begin, request.end, room));
    core::TraceRecorder& recorder = *recorders.cores.back();
    machine.core(i).observe(recorder);
    machine.rt_unit(i).warp_moved().listen([&recorder](const rt::WarpMoved& moved) {
      if (moved.has_left)
        recorder.leave_rt(moved.cycle, moved.buffer_slot, moved.lanes, moved.states);
      else
        recorder.enter_rt(moved.cycle, moved.buffer_slot, moved.warp_slot, moved.lanes, moved.states);
    });
  }
  const uint32_t channels = machine.memory().num_partitions();
  for (uint32_t i = 0; i < channels; ++i) {
    recorders.channels.push_back(std::make_unique<ChannelRecorder>(
        i, request.begin, request.end, std::max<uint64_t>(channel_room(request) / channels, 1)));
    machine.memory().partition(i).dram_turned().listen(
        [&recorder = *recorders.channels.back()](const mem::DramTurn& to) { recorder.turn(to); });
  }
  return recorders;
}

TraceTable trace_of(TimingMachine& machine, const exec::Image& image, const TraceRequest& request,
                    const TraceRecorders& recorders, Cycle interval) {
  TraceTable table;
  table.begin = request.begin;
  table.end = table.asked_end = std::max(request.begin, std::min(request.end, machine.attributed_cycles()));
  table.limit = request.limit;
  for (const auto& recorder : recorders.cores) table.end = std::min(table.end, recorder->end());
  for (const auto& recorder : recorders.channels) table.end = std::min(table.end, recorder->end());
  for (const exec::Shader& shader : image.shaders) {
    table.shaders.push_back(shader.name);
    table.stages.emplace_back(isa::name_of(shader.stage));
  }
  table.states = core::TraceRecorder::state_names();
  for (const auto& recorder : recorders.cores) table.cores.push_back(sorted(recorder->slices(), table.end));
  for (uint32_t i = 0; i < recorders.channels.size(); ++i) {
    recorders.channels[i]->finish(machine.attributed_cycles(),
                                  machine.memory().partition(i).dram().stats().requests.value());
    table.channels.push_back(sorted(recorders.channels[i]->slices(), table.end));
  }
  table.counters = counters_of(machine, table, interval);
  keep_within(table, counter_room(request));
  return table;
}

}  // namespace glint::pipeline
