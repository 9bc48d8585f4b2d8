// Reads a window of a trace back for the timeline of the report.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "base/diagnostics.h"
#include "report/files/gzip.h"
#include "report/files/trace_files.h"

namespace glint::report {
namespace {

using TraceJson = nlohmann::json;

constexpr uint32_t kFirstCoreProcess = 2;  // process of core 0

UserError damaged(const std::string& path) {
  return UserError({path}, "this is not a trace of a run", "`glint run ... --trace` writes one");
}

// Returns the line's object, without what joins it to the next one.
TraceJson parsed(std::string_view line) {
  while (!line.empty() && (line.back() == ',' || line.back() == '\r')) line.remove_suffix(1);
  return TraceJson::parse(line, nullptr, false);
}

void read_head(std::string_view line, const std::string& path, Timeline& timeline) {
  const TraceJson head = parsed(std::string(line.substr(0, line.rfind(','))) + "}");
  if (!head.is_object() || !head.contains("otherData") || !head["otherData"].contains("begin"))
    throw damaged(path);
  const TraceJson& about = head["otherData"];
  timeline.trace_begin = about["begin"];
  timeline.trace_end = about["end"];
  timeline.cores = about["cores"];
}

Timeline::Slice slice_of(const TraceJson& event) {
  Timeline::Slice slice{event["tid"], event["cat"], event["name"], event["ts"], event["dur"], {}};
  if (event.contains("args"))
    for (const auto& [name, value] : event["args"].items())
      if (value.is_number()) slice.args[name] = value;
  return slice;
}

// Returns the cycles around `middle` that no more than `most` slices overlap.
std::pair<Cycle, Cycle> fitting(const std::vector<Timeline::Slice>& slices, Cycle first, Cycle last,
                                size_t most) {
  const Cycle middle = first + (last - first) / 2;
  const auto within = [&](Cycle half) {
    const Cycle begin = middle - std::min(half, middle - first), end = std::min(middle + half, last);
    return size_t(std::count_if(slices.begin(), slices.end(),
                                [&](const auto& s) { return s.begin < end && s.begin + s.length > begin; }));
  };
  Cycle low = 1, high = std::max<Cycle>(last - middle, 1);  // within(low) is assumed to fit
  if (within(high) <= most) return {first, last};
  while (low + 1 < high) (within((low + high) / 2) <= most ? low : high) = (low + high) / 2;
  return {middle - std::min(low, middle - first), std::min(middle + low, last)};
}

// Cuts slices at the window's ends.
void clip(Timeline& timeline) {
  std::vector<Timeline::Slice> kept;
  for (Timeline::Slice& slice : timeline.slices) {
    const Cycle end = std::min(slice.begin + slice.length, timeline.end),
                begin = std::max(slice.begin, timeline.begin);
    if (begin >= end) continue;
    slice.begin = begin;
    slice.length = end - begin;
    kept.push_back(std::move(slice));
  }
  timeline.slices = std::move(kept);
}

// Ends the window where it holds no more than `most` slices.
void bound(Timeline& timeline, size_t most) {
  if (timeline.slices.size() <= most) return;
  timeline.is_cut = true;
  std::vector<Cycle> begins;
  for (const Timeline::Slice& slice : timeline.slices) begins.push_back(slice.begin);
  std::nth_element(begins.begin(), begins.begin() + std::ptrdiff_t(most), begins.end());
  timeline.end = std::max(begins[most], timeline.begin + 1);
  clip(timeline);
}

}  // namespace

Timeline read_timeline(const std::string& path, const TimelineRequest& request) {
  Timeline timeline;
  timeline.core = request.core;
  const std::string wanted = fmt::format(R"({{"ph":"X","pid":{},)", kFirstCoreProcess + request.core);
  bool has_head = false;
  read_gzip_lines(path, [&](std::string_view line) {
    if (!has_head) read_head(line, path, timeline), has_head = true;
    if (line.substr(0, wanted.size()) != wanted) return true;
    const TraceJson event = parsed(line);
    if (!event.is_object()) throw damaged(path);
    timeline.slices.push_back(slice_of(event));
    return true;
  });
  if (!has_head) throw damaged(path);
  if (request.core >= timeline.cores)
    throw UserError({path}, fmt::format("this trace has no SM {}", request.core),
                    fmt::format("its SMs are 0 to {}", timeline.cores - 1));
  const Cycle first = timeline.trace_begin, last = timeline.trace_end;
  if (request.end && (request.begin >= last || request.end <= first))
    throw UserError({path},
                    fmt::format("this trace has nothing of cycles {} to {}", request.begin, request.end),
                    fmt::format("it shows cycles {} to {}", first, last));
  if (request.end)
    std::tie(timeline.begin, timeline.end) =
        std::pair(std::max(request.begin, first), std::min(request.end, last));
  else
    std::tie(timeline.begin, timeline.end) = fitting(timeline.slices, first, last, request.most_slices);
  clip(timeline);
  bound(timeline, request.most_slices);
  const auto depth = [](const Timeline::Slice& s) {
    return s.kind == "warp" ? 0 : s.kind == "stage" ? 1 : 2;
  };
  std::stable_sort(timeline.slices.begin(), timeline.slices.end(), [&](const auto& a, const auto& b) {
    return std::pair(a.begin, depth(a)) < std::pair(b.begin, depth(b));
  });
  return timeline;
}

}  // namespace glint::report
