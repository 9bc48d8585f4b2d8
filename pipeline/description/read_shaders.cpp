// Reads shaders, groups, records and constants.
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

void add_shader_file(Reading& r, const std::string& name, const SourceLocation& where) {
  if (name.empty()) return;
  for (const ShaderFile& shader : r.out.shaders)
    if (shader.name == name) return;
  r.out.shaders.push_back({name, r.beside(name), "", r.glsl, where});
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

void add_group(Reading& r, const GroupDescription& group) {
  for (const std::string& name : {group.general, group.closest_hit, group.any_hit, group.intersection})
    add_shader_file(r, name, group.where);
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

RecordDescription read_record(Reading& r, const Value& value, Region region, const std::string& what) {
  TableReader t(value, what, r.errors);
  RecordDescription record;
  record.where = value.where;
  record.group = t.text("group");
  record.inlined = read_group(t, region);
  record.data = read_data(r, t, false);
  t.finish();
  add_group(r, record.inlined);
  if (!record.group.empty() && record.inlined.general + record.inlined.closest_hit + record.inlined.any_hit +
                                       record.inlined.intersection !=
                                   "")
    r.errors.error(value.where, fmt::format("{} has both 'group' and shaders", what));
  return record;
}

void read_region(Reading& r, TableReader& root, RegionDescription& region, const std::string& key,
                 Region kind) {
  for (const Value* each : root.tables(key))
    region.records.push_back(read_record(r, *each, kind, fmt::format("a record of '{}'", key)));
}

void read_strides(Reading& r, TableReader& root) {
  for (const Value* each : root.tables("table")) {
    TableReader t(*each, "the binding table", r.errors);
    for (const auto& [key, region] : {std::pair{"miss_stride", &r.out.miss},
                                      {"hit_stride", &r.out.hit},
                                      {"callable_stride", &r.out.callable}})
      if (const auto stride = t.optional_integer(key, 0, 4096))
        region->stride = uint32_t(*stride), region->stride_where = t.take(key)->where;
    t.finish();
  }
}

}  // namespace

void read_shaders(Reading& r, TableReader& root) {
  for (const Value* each : root.tables("compile")) {
    TableReader t(*each, "[compile]", r.errors);
    r.glsl = read_glsl(r, t, r.glsl);
    t.finish();
  }
  for (const Value* each : root.tables("shader")) {
    TableReader t(*each, "a shader", r.errors);
    const std::string file = t.required_text("file");
    ShaderFile shader{t.text("name", file), r.beside(file), t.text("entry"), read_glsl(r, t, r.glsl),
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
    add_group(r, group);
    r.out.groups.push_back(std::move(group));
  }
  read_region(r, root, r.out.miss, "miss", Region::General);
  read_region(r, root, r.out.hit, "hit", Region::Hit);
  read_region(r, root, r.out.callable, "callable", Region::General);
  read_strides(r, root);
}

RecordDescription read_raygen(Reading& r, const Value& value) {
  return read_record(r, value, Region::Raygen, "[raygen]");
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
  read_launches(r, t);
  read_resources(r, t);
  if (const Value* constants = t.take("specialization")) out.specialization = *constants;
  t.finish();
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
