// Writes traces.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/trace_files.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "report/files/gzip.h"

namespace glint::report {
namespace {

constexpr uint32_t kGpuProcess = 1, kFirstCore = 2, kFirstWarpSlot = 1, kFirstPlace = 1001;

class Writer {
 public:
  explicit Writer(const TraceTable& trace) : trace_(trace) {}

  std::string write() {
    begin();
    name_process(kGpuProcess, "GPU");
    for (uint32_t i = 0; i < trace_.cores.size(); ++i) write_core(i);
    name_process(memory(), "Memory");
    for (uint32_t i = 0; i < trace_.channels.size(); ++i) write_channel(i);
    for (const TraceCounter& counter : trace_.counters) write_counter(counter);
    file_.add("\n]}\n");
    return file_.finish();
  }

 private:
  static std::string quoted(const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  }
  uint32_t memory() const { return kFirstCore + uint32_t(trace_.cores.size()); }

  void begin() {
    const nlohmann::ordered_json about = {{"unit", "a microsecond of this trace is a cycle"},
                                          {"begin", trace_.begin},
                                          {"end", trace_.end},
                                          {"asked_end", trace_.asked_end},
                                          {"cut", trace_.is_cut()},
                                          {"limit", trace_.limit},
                                          {"events", num_events(trace_)},
                                          {"counters_left_out", trace_.counters_left_out},
                                          {"cores", trace_.cores.size()}};
    file_.add("{\"otherData\":" + about.dump() + ",\n\"displayTimeUnit\":\"ms\",\"traceEvents\":[");
  }
  void event(const std::string& text) {
    file_.add(is_first_ ? "\n" : ",\n");
    is_first_ = false;
    file_.add(text);
  }
  void name_process(uint32_t process, const std::string& name) {
    event(
        fmt::format(R"({{"ph":"M","pid":{},"name":"process_name","args":{{"name":"{}"}}}})", process, name));
    event(fmt::format(R"({{"ph":"M","pid":{},"name":"process_sort_index","args":{{"sort_index":{}}}}})",
                      process, process));
  }
  void name_thread(uint32_t process, uint32_t thread, const std::string& name) {
    event(fmt::format(R"({{"ph":"M","pid":{},"tid":{},"name":"thread_name","args":{{"name":"{}"}}}})",
                      process, thread, name));
    event(
        fmt::format(R"({{"ph":"M","pid":{},"tid":{},"name":"thread_sort_index","args":{{"sort_index":{}}}}})",
                    process, thread, thread));
  }

  void write_core(uint32_t core) {
    const uint32_t process = kFirstCore + core;
    name_process(process, fmt::format("SM {}", core));
    uint32_t named = 0;  // thread whose name was written last; slices come track by track
    for (const TraceSlice& slice : trace_.cores[core]) {
      const bool in_rt = slice.kind == TraceKind::Rays;
      const uint32_t thread = slice.place + (in_rt ? kFirstPlace : kFirstWarpSlot);
      if (thread != named)
        name_thread(process, thread, fmt::format("{} {:02}", in_rt ? "RT place" : "warp slot", slice.place));
      named = thread;
      event(fmt::format(R"({{"ph":"X","pid":{},"tid":{},"ts":{},"dur":{},{}}})", process, thread, slice.begin,
                        slice.end - slice.begin, what(slice)));
    }
  }
  void write_channel(uint32_t channel) {
    if (trace_.channels[channel].empty()) return;
    name_thread(memory(), kFirstWarpSlot + channel, fmt::format("channel {:02}", channel));
    for (const TraceSlice& slice : trace_.channels[channel])
      event(fmt::format(R"({{"ph":"X","pid":{},"tid":{},"ts":{},"dur":{},{}}})", memory(),
                        kFirstWarpSlot + channel, slice.begin, slice.end - slice.begin, what(slice)));
  }
  std::string what(const TraceSlice& slice) const {
    switch (slice.kind) {
      case TraceKind::Warp:
        return fmt::format(R"("cat":"warp","name":"warp {}","args":{{"warp":{}}})", slice.value, slice.value);
      case TraceKind::Stage:
        return fmt::format(R"("cat":"stage","name":{},"args":{{"shader":{}}})",
                           quoted(trace_.stages[slice.value]), quoted(trace_.shaders[slice.value]));
      case TraceKind::State:
        return fmt::format(R"("cat":"state","name":"{}")", trace_.states[slice.value]);
      case TraceKind::Channel:
        return fmt::format(R"("cat":"channel","name":"requests","args":{{"requests":{}}})", slice.value);
      case TraceKind::Rays:
        break;
    }
    return fmt::format(
        R"("cat":"rays","name":"rays","args":{{"rays":{},"warp_slot":{},"nodes":{},"triangle_tests":{}}})",
        slice.value, slice.args[0], slice.args[1], slice.args[2]);
  }
  void write_counter(const TraceCounter& counter) {
    const bool is_channel = counter.of == TraceCounter::Of::Channel;
    const uint32_t process = counter.of == TraceCounter::Of::Gpu ? kGpuProcess
                             : is_channel                        ? memory()
                                                                 : kFirstCore + counter.index;
    const std::string name =
        is_channel ? fmt::format("channel {}: {}", counter.index, counter.name) : counter.name;
    for (const auto& [cycle, value] : counter.values)
      event(fmt::format(R"({{"ph":"C","pid":{},"ts":{},"name":"{}","args":{{"{}":{}}}}})", process, cycle,
                        name, counter.unit, value));
  }

  const TraceTable& trace_;
  GzipWriter file_;
  bool is_first_ = true;
};

}  // namespace

uint64_t num_events(const TraceTable& trace) {
  uint64_t events = 0;
  for (const auto& core : trace.cores) events += core.size();
  for (const auto& channel : trace.channels) events += channel.size();
  for (const TraceCounter& counter : trace.counters) events += counter.values.size();
  return events;
}

std::string trace_json_gz(const TraceTable& trace) {
  return Writer(trace).write();
}

}  // namespace glint::report
