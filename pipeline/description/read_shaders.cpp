// Reads shaders, groups, records, constants, launch and machine.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <utility>
#include <vector>

#include "pipeline/description/read.h"

namespace glint::pipeline {

std::string Reading::beside(const std::string& file) const {
  return file.empty() ? file : (std::filesystem::path(out.path).parent_path() / file).string();
}

namespace {

std::string text_of(const Value& v) {
  switch (v.kind) {
    case Value::Kind::Text:
      return v.text;
    case Value::Kind::Integer:
      return fmt::format("{}", v.whole);
    case Value::Kind::Real:
      return fmt::format("{}", v.real);
    case Value::Kind::Bool:
      return v.flag ? "1" : "0";
    default:
      return "1";
  }
}

void read_defines(TableReader& t, frontend::GlslOptions& glsl) {
  const Value* defines = t.take("define");
  if (!defines) return;
  for (const auto& [name, value] : defines->table) glsl.defines.emplace_back(name, text_of(value));
}

frontend::GlslOptions read_glsl(Reading& r, TableReader& t, frontend::GlslOptions glsl) {
  for (const std::string& folder : t.texts("include")) glsl.include_dirs.push_back(r.beside(folder));
  read_defines(t, glsl);
  return glsl;
}

// Adds a shader file that only a record names, without any [[shader]].
void add_file(Reading& r, const std::string& name, const SourceLocation& where,
              const frontend::GlslOptions& glsl) {
  if (name.empty()) return;
  for (const ShaderFile& shader : r.out.shaders)
    if (shader.name == name) return;
  r.out.shaders.push_back({name, r.beside(name), "", glsl, where});
}

void add_group(Reading& r, const GroupDescription& group, const frontend::GlslOptions& glsl) {
  for (const std::string& name : {group.general, group.closest_hit, group.any_hit, group.intersection})
    add_file(r, name, group.where, glsl);
}

enum class Region { Raygen, Hit, General };

GroupDescription read_group(TableReader& t, Region region) {
  GroupDescription group;
  group.where = t.where();
  if (region != Region::Hit) group.general = t.text("shader");
  if (region != Region::General && region != Region::Raygen) {
    group.closest_hit = t.text("closest_hit");
    group.any_hit = t.text("any_hit");
    group.intersection = t.text("intersection");
  }
  return group;
}

RecordDescription read_record(Reading& r, const Value& value, Region region, const std::string& what,
                              const frontend::GlslOptions& glsl) {
  TableReader t(value, what, r.errors);
  RecordDescription record;
  record.where = value.where;
  record.group = t.text("group");
  record.inlined = read_group(t, region);
  record.data = read_data(r, t, false);
  t.finish();
  add_group(r, record.inlined, glsl);
  if (!record.group.empty() && record.inlined.general + record.inlined.closest_hit + record.inlined.any_hit +
                                       record.inlined.intersection !=
                                   "")
    r.errors.error(value.where, fmt::format("{} has both 'group' and shaders", what));
  return record;
}

void read_region(Reading& r, TableReader& root, RegionDescription& region, const std::string& key,
                 Region kind, const frontend::GlslOptions& glsl) {
  for (const Value* each : root.tables(key))
    region.records.push_back(read_record(r, *each, kind, fmt::format("a record of '{}'", key), glsl));
}

void read_strides(Reading& r, TableReader& root) {
  for (const Value* each : root.tables("table")) {
    TableReader t(*each, "the binding table", r.errors);
    for (const auto& [key, region] : {std::pair{"miss_stride", &r.out.miss},
                                      {"hit_stride", &r.out.hit},
                                      {"callable_stride", &r.out.callable}})
      if (const auto stride = t.optional_integer(key, 0, 4096)) region->stride = uint32_t(*stride);
    t.finish();
  }
}

}  // namespace

void read_shaders(Reading& r, TableReader& root) {
  frontend::GlslOptions glsl;
  for (const Value* each : root.tables("compile")) {
    TableReader t(*each, "[compile]", r.errors);
    glsl = read_glsl(r, t, glsl);
    t.finish();
  }
  for (const Value* each : root.tables("shader")) {
    TableReader t(*each, "a shader", r.errors);
    const std::string file = t.required_text("file");
    ShaderFile shader{t.text("name", file), r.beside(file), t.text("entry"), read_glsl(r, t, glsl),
                      each->where};
    t.finish();
    for (const ShaderFile& other : r.out.shaders)
      if (other.name == shader.name)
        r.errors.error(each->where, fmt::format("there are two shaders '{}'", shader.name),
                       "give one of them a 'name'");
    r.out.shaders.push_back(std::move(shader));
  }
  for (const Value* each : root.tables("group")) {
    TableReader t(*each, "a group", r.errors);
    GroupDescription group = read_group(t, Region::Hit);
    group.general = t.text("shader");
    group.name = t.required_text("name");
    t.finish();
    add_group(r, group, glsl);
    r.out.groups.push_back(std::move(group));
  }
  if (const Value* raygen = root.take("raygen"))
    r.out.raygen = read_record(r, *raygen, Region::Raygen, "[raygen]", glsl);
  if (const Value* compute = root.take("compute")) {
    TableReader t(*compute, "[compute]", r.errors);
    r.out.compute = t.required_text("shader");
    r.out.compute_where = compute->where;
    t.finish();
    add_file(r, r.out.compute, compute->where, glsl);
  }
  read_region(r, root, r.out.miss, "miss", Region::General, glsl);
  read_region(r, root, r.out.hit, "hit", Region::Hit, glsl);
  read_region(r, root, r.out.callable, "callable", Region::General, glsl);
  read_strides(r, root);
}

void read_launch(Reading& r, TableReader& root) {
  const Value* launch = root.take("launch");
  if (launch) {
    TableReader t(*launch, "[launch]", r.errors);
    const bool is_compute = !r.out.compute.empty();
    const char* key = is_compute ? "groups" : "size";
    if (const Value* other = t.take(is_compute ? "size" : "groups"))
      r.errors.error(other->where, is_compute ? "a compute shader is launched in 'groups' of its local size"
                                              : "rays are launched by 'size'");
    const std::vector<uint32_t> size = t.sizes(key, 3);
    if (!size.empty()) r.out.launch = {1, 1, 1};
    std::copy(size.begin(), size.end(), r.out.launch.begin());
    if (const auto depth = t.optional_integer("max_trace_depth", 0, 31))
      r.out.max_trace_depth = uint32_t(*depth);
    if (const auto depth = t.optional_integer("max_callable_depth", 0, 31))
      r.out.max_callable_depth = uint32_t(*depth);
    t.finish();
  }
  if (r.out.launch[0] == 0)
    r.errors.error(launch ? launch->where : SourceLocation{r.out.path, 0, 0},
                   r.out.compute.empty() ? "[launch] needs 'size', the numbers of rays in x, y and z"
                                         : "[launch] needs 'groups', the numbers of blocks in x, y and z");
  for (const Value* each : root.tables("machine")) {
    TableReader t(*each, "[machine]", r.errors);
    if (t.take("mode")) r.out.machine.mode = t.name("mode", "timing", {"timing", "functional"});
    r.out.machine.config = t.text("config");
    r.out.machine.settings = t.texts("set");
    r.out.machine.max_instructions = uint64_t(t.integer("max_instructions", 0, 1, INT64_MAX));
    t.finish();
  }
}

PipelineDescription read_root(const Value& root, const std::string& path) {
  Diagnostics errors;
  PipelineDescription out;
  out.path = path;
  out.name = std::filesystem::path(path).stem().string();
  Reading r{out, errors};
  TableReader t(root, "a pipeline", errors);
  out.name = t.text("name", out.name);
  read_shaders(r, t);
  read_launch(r, t);
  read_resources(r, t);
  if (const Value* push = t.take("push_constants")) {
    out.push_constants.where = push->where;
    const Value* data = push->find("data");
    out.push_constants.data = data ? *data : *push;
  }
  if (const Value* constants = t.take("specialization")) out.specialization = *constants;
  t.finish();
  if (out.raygen.has_value() == !out.compute.empty())
    errors.error({path, 0, 0}, out.raygen ? "a pipeline has [raygen] or [compute], not both"
                                          : "a pipeline needs [raygen] or [compute]");
  if (out.compute.empty() == false &&
      !(out.miss.records.empty() && out.hit.records.empty() && out.callable.records.empty()))
    errors.error(out.compute_where, "a compute pipeline has no records of miss, hit or callable shaders");
  errors.throw_if_errors();
  return out;
}

PipelineDescription read_pipeline(const std::string& path) {
  return read_root(read_toml(path), path);
}
PipelineDescription parse_pipeline(const std::string& text, const std::string& path) {
  return read_root(parse_toml(text, path), path);
}

}  // namespace glint::pipeline
