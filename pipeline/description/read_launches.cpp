// Reads what is launched, in which order, and on which machine.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <set>
#include <utility>
#include <vector>

#include "pipeline/description/read.h"

namespace glint::pipeline {
namespace {

DataSource constants_of(const Value& push) {
  DataSource out;
  out.where = push.where;
  const Value* data = push.find("data");
  out.data = data ? *data : push;
  return out;
}

// Reads what every form of a launch has, into a launch that has its shader.
void read_size(Reading& r, TableReader& t, LaunchDescription& launch, const std::string& what) {
  const bool is_compute = !launch.compute.empty();
  const char* key = is_compute ? "groups" : "size";
  if (const Value* other = t.take(is_compute ? "size" : "groups"))
    r.errors.error(other->where, is_compute ? "a compute shader is launched in 'groups' of its local size"
                                            : "rays are launched by 'size'");
  const std::vector<uint32_t> size = t.sizes(key, 3);
  if (!size.empty()) launch.size = {1, 1, 1};
  std::copy(size.begin(), size.end(), launch.size.begin());
  if (size.empty())
    r.errors.error(t.where(), is_compute ? what + " needs 'groups', the numbers of blocks in x, y and z"
                                         : what + " needs 'size', the numbers of rays in x, y and z");
  if (const auto depth = t.optional_integer("max_trace_depth", 0, 31))
    launch.max_trace_depth = uint32_t(*depth);
  if (const auto depth = t.optional_integer("max_callable_depth", 0, 31))
    launch.max_callable_depth = uint32_t(*depth);
}

// Reads an element of [[launch]]. What it does not say is as in `common`.
void read_one(Reading& r, const Value& value, const LaunchDescription& common) {
  TableReader t(value, "a launch of a list", r.errors);
  LaunchDescription launch = common;
  launch.where = value.where;
  const Value* const compute = t.take("compute");
  const Value* const raygen = t.take("raygen");
  if (compute && raygen) r.errors.error(value.where, "a launch has 'raygen' or 'compute', not both");
  if (compute) launch.compute = t.text("compute"), launch.raygen.reset();
  if (raygen && raygen->kind == Value::Kind::Table) {
    launch.raygen = read_raygen(r, *raygen), launch.compute.clear();
  } else if (raygen) {
    launch.raygen.emplace(), launch.compute.clear();
    launch.raygen->where = launch.raygen->inlined.where = raygen->where;
    launch.raygen->inlined.general = t.text("raygen");
    add_shader_file(r, launch.raygen->inlined.general, raygen->where);
  }
  add_shader_file(r, launch.compute, value.where);
  if (launch.compute.empty() && !launch.raygen)
    r.errors.error(value.where, "a launch needs 'raygen' or 'compute', a shader");
  launch.name = t.required_text("name");
  if (launch.name.find_first_of("/\\") != std::string::npos || launch.name.starts_with('.'))
    r.errors.error(value.where, fmt::format("'{}' names a folder, so it has no slash and no dot at its start",
                                            launch.name));
  read_size(r, t, launch, "a launch");
  if (const Value* push = t.take("push_constants")) launch.push_constants = constants_of(*push);
  launch.warm = t.name("caches", "cold", {"cold", "warm"}) == "warm";
  t.finish();
  r.out.launches.push_back(std::move(launch));
}

void read_list(Reading& r, const std::vector<const Value*>& all, const LaunchDescription& common) {
  std::set<std::string> names;
  for (const Value* each : all) read_one(r, *each, common);
  for (const LaunchDescription& launch : r.out.launches)
    if (!launch.name.empty() && !names.insert(launch.name).second)
      r.errors.error(launch.where, fmt::format("there are two launches '{}'", launch.name));
}

// Returns the constants of a launch in a frame, whose number stands where they say "frame".
DataSource in_frame(DataSource constants, int64_t frame) {
  for (Entry& entry : constants.data.table)
    if (entry.value.kind == Value::Kind::Text && entry.value.text == "frame") {
      entry.value.kind = Value::Kind::Integer;
      entry.value.whole = frame, entry.value.real = double(frame);
    }
  return constants;
}

// Repeats the list of launches for each frame.
void read_frames(Reading& r, const Value& value, bool is_list) {
  constexpr int64_t kMostFrames = 10'000;
  TableReader t(value, "[frames]", r.errors);
  const int64_t count = t.integer("count", 1, 1, kMostFrames);
  if (!t.take("count")) r.errors.error(value.where, "[frames] needs 'count', the number of frames");
  t.finish();
  if (!is_list) {
    r.errors.error(value.where, "[frames] repeats a list of launches, and there is none",
                   "write [[launch]] with a name instead of [launch]");
    return;
  }
  std::vector<LaunchDescription> all;
  for (int64_t frame = 0; frame < count; ++frame)
    for (const LaunchDescription& one : r.out.launches) {
      LaunchDescription& made = all.emplace_back(one);
      made.name = fmt::format("frame{}-{}", frame, one.name);
      made.push_constants = in_frame(one.push_constants, frame);
    }
  r.out.launches = std::move(all);
}

void read_single(Reading& r, const Value* value, LaunchDescription launch) {
  if (launch.raygen.has_value() == !launch.compute.empty())
    r.errors.error({r.out.path, 0, 0}, launch.raygen ? "a pipeline has [raygen] or [compute], not both"
                                                     : "a pipeline needs [raygen] or [compute]");
  Value none;
  none.kind = Value::Kind::Table, none.where = {r.out.path, 0, 0};
  TableReader t(value ? *value : none, "[launch]", r.errors);
  read_size(r, t, launch, "[launch]");
  t.finish();
  r.out.launches.push_back(std::move(launch));
}

void read_machine(Reading& r, TableReader& root) {
  for (const Value* each : root.tables("machine")) {
    TableReader t(*each, "[machine]", r.errors);
    if (t.take("mode")) r.out.machine.mode = t.name("mode", "timing", {"timing", "functional"});
    r.out.machine.config = t.text("config");
    r.out.machine.settings = t.texts("set");
    r.out.machine.max_instructions = uint64_t(t.integer("max_instructions", 0, 1, INT64_MAX));
    t.finish();
  }
}

}  // namespace

void read_launches(Reading& r, TableReader& root) {
  LaunchDescription common;
  common.where = {r.out.path, 0, 0};
  if (const Value* raygen = root.take("raygen")) common.raygen = read_raygen(r, *raygen);
  if (const Value* compute = root.take("compute")) {
    TableReader t(*compute, "[compute]", r.errors);
    common.compute = t.required_text("shader");
    common.where = compute->where;
    t.finish();
    add_shader_file(r, common.compute, compute->where);
  }
  if (const Value* push = root.take("push_constants")) common.push_constants = constants_of(*push);
  const Value* const launch = root.take("launch");
  if (launch && launch->kind == Value::Kind::List)
    read_list(r, root.tables("launch"), common);
  else
    read_single(r, launch, common);
  if (const Value* frames = root.take("frames"))
    read_frames(r, *frames, launch && launch->kind == Value::Kind::List);
  const auto& has_records = [&](const RegionDescription& region) { return !region.records.empty(); };
  const auto is_compute = [](const LaunchDescription& one) { return !one.compute.empty(); };
  if (std::all_of(r.out.launches.begin(), r.out.launches.end(), is_compute) &&
      (has_records(r.out.miss) || has_records(r.out.hit) || has_records(r.out.callable)))
    r.errors.error(r.out.launches[0].where,
                   "a compute pipeline has no records of miss, hit or callable shaders");
  read_machine(r, root);
}

}  // namespace glint::pipeline
