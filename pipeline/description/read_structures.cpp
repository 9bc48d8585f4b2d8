// Reads acceleration structures: bottom levels, top levels and their instances.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <numbers>
#include <utility>
#include <vector>

#include "pipeline/description/read.h"
#include "pipeline/description/read_opacity.h"

namespace glint::pipeline {
namespace {

using Matrix = std::array<float, 12>;

// Reads `transform` (12 numbers, row after row). Without that key, it applies scale, then rotation in degrees
// about x, y and z in turn, then translation.
Matrix read_transform(Reading& r, TableReader& t) {
  Matrix out = rt::kIdentity;
  const std::vector<double> rows = t.numbers("transform"), moved = t.numbers("translate"),
                            turned = t.numbers("rotate"), scaled = t.numbers("scale");
  const auto check = [&](const char* key, const std::vector<double>& v, bool good, const char* expected) {
    if (!v.empty() && !good)
      r.errors.error(t.take(key)->where,
                     fmt::format("'{}' has {} numbers, expected {}", key, v.size(), expected));
    return v.empty() || good;
  };
  if (!check("transform", rows, rows.size() == 12, "12: three rows of four") ||
      !check("translate", moved, moved.size() == 3, "3") ||
      !check("rotate", turned, turned.size() == 3, "3: degrees about x, y and z") ||
      !check("scale", scaled, scaled.size() == 1 || scaled.size() == 3, "1 or 3"))
    return out;
  if (!rows.empty()) {
    if (!moved.empty() || !turned.empty() || !scaled.empty())
      r.errors.error(t.take("transform")->where,
                     "'transform' stands alone, without translate, rotate and scale");
    std::transform(rows.begin(), rows.end(), out.begin(), [](double v) { return float(v); });
    return out;
  }
  double m[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int axis = 0; axis < 3; ++axis) {
    const double angle = turned.empty() ? 0 : turned[size_t(axis)] * std::numbers::pi / 180,
                 c = std::cos(angle), s = std::sin(angle);
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    for (int column = 0; column < 3; ++column) {
      const double x = m[a][column], y = m[b][column];
      m[a][column] = c * x - s * y, m[b][column] = s * x + c * y;
    }
  }
  for (size_t row = 0; row < 3; ++row) {
    for (size_t column = 0; column < 3; ++column)
      out[row * 4 + column] = float(m[row][column] * (scaled.empty()       ? 1
                                                      : scaled.size() == 1 ? scaled[0]
                                                                           : scaled[column]));
    out[row * 4 + 3] = moved.empty() ? 0.0f : float(moved[row]);
  }
  return out;
}

GeometryDescription read_geometry(Reading& r, const Value& value) {
  TableReader t(value, "a geometry", r.errors);
  GeometryDescription out;
  out.where = value.where;
  out.mesh = r.beside(t.text("file"));
  for (double v : t.numbers("vertices")) out.vertices.push_back(float(v));
  for (double v : t.numbers("indices")) out.indices.push_back(uint32_t(v));
  const std::vector<double> boxes = t.numbers("aabbs");
  if (boxes.size() % 6)
    r.errors.error(
        t.take("aabbs")->where,
        fmt::format("'aabbs' has {} numbers, expected six per box: low corner, high corner", boxes.size()));
  for (size_t i = 0; i + 6 <= boxes.size(); i += 6)
    out.aabbs.push_back({{float(boxes[i]), float(boxes[i + 1]), float(boxes[i + 2])},
                         {float(boxes[i + 3]), float(boxes[i + 4]), float(boxes[i + 5])}});
  out.opaque = t.flag("opaque", true);
  out.no_duplicate_any_hit = t.flag("no_duplicate_any_hit", false);
  out.opacity = read_opacity(r, t, value.where);
  out.transform = read_transform(r, t);
  t.finish();
  const int kinds = int(!out.mesh.empty()) + int(!out.vertices.empty()) + int(!boxes.empty());
  if (kinds != 1)
    r.errors.error(
        value.where,
        "a geometry has one of 'file' (.obj, .gltf, .glb), 'vertices' (and 'indices') and 'aabbs'");
  if (out.opacity && !boxes.empty())
    r.errors.error(value.where, "boxes have no opacity maps, only triangles");
  if (out.vertices.size() % 3)
    r.errors.error(value.where,
                   fmt::format("'vertices' has {} numbers, expected three per vertex", out.vertices.size()));
  const size_t corners = out.indices.empty() ? out.vertices.size() / 3 : out.indices.size();
  if (corners % 3)
    r.errors.error(value.where, fmt::format("{} corners do not make a whole number of triangles", corners));
  for (uint32_t index : out.indices)
    if (index >= out.vertices.size() / 3) {
      r.errors.error(t.take("indices")->where, fmt::format("index {} is too large: there are {} vertices",
                                                           index, out.vertices.size() / 3));
      break;
    }
  return out;
}

uint32_t read_flags(Reading& r, TableReader& t) {
  static const std::vector<std::pair<std::string, uint32_t>> kFlags{
      {"facing_cull_disable", rt::instance_flag::kFacingCullDisable},
      {"flip_facing", rt::instance_flag::kFlipFacing},
      {"force_opaque", rt::instance_flag::kForceOpaque},
      {"force_no_opaque", rt::instance_flag::kForceNoOpaque},
      {"force_opacity_2_states", rt::instance_flag::kForceMicromaps2State},
      {"disable_opacity_maps", rt::instance_flag::kDisableMicromaps}};
  uint32_t out = 0;
  for (const std::string& name : t.texts("flags")) {
    const auto found =
        std::find_if(kFlags.begin(), kFlags.end(), [&](const auto& f) { return f.first == name; });
    if (found != kFlags.end())
      out |= found->second;
    else
      r.errors.error(t.take("flags")->where, fmt::format("'{}' is not a flag of an instance", name),
                     "the flags are facing_cull_disable, flip_facing, force_opaque, force_no_opaque, "
                     "force_opacity_2_states and disable_opacity_maps");
  }
  return out;
}

InstanceDescription read_instance(Reading& r, const Value& value) {
  TableReader t(value, "an instance", r.errors);
  InstanceDescription out;
  out.where = value.where;
  out.bottom_level = t.required_text("bottom_level");
  out.instance.transform = read_transform(r, t);
  out.instance.custom_index = uint32_t(t.integer("custom_index", 0, 0, (1 << 24) - 1));
  out.instance.mask = uint32_t(t.integer("mask", 0xff, 0, 0xff));
  out.instance.sbt_offset = uint32_t(t.integer("sbt_offset", 0, 0, (1 << 24) - 1));
  out.instance.flags = read_flags(r, t);
  t.finish();
  return out;
}

void check_names(Reading& r) {
  std::vector<std::string> names;
  for (const auto& level : r.out.bottom_levels) names.push_back(level.name);
  for (const auto& top : r.out.top_levels)
    for (const auto& instance : top.instances) {
      if (instance.bottom_level.empty() ||
          std::find(names.begin(), names.end(), instance.bottom_level) != names.end())
        continue;
      const std::string near = nearest(instance.bottom_level, names);
      r.errors.error(instance.where, fmt::format("there is no bottom level '{}'", instance.bottom_level),
                     near.empty() ? "" : fmt::format("did you mean '{}'?", near));
    }
}

}  // namespace

void read_structures(Reading& r, TableReader& root) {
  for (const Value* each : root.tables("bottom_level")) {
    TableReader t(*each, "a bottom level", r.errors);
    BottomLevelDescription level;
    level.name = t.required_text("name");
    level.where = each->where;
    for (const Value* geometry : t.tables("geometry"))
      level.geometries.push_back(read_geometry(r, *geometry));
    t.finish();
    r.out.bottom_levels.push_back(std::move(level));
  }
  for (const Value* each : root.tables("top_level")) {
    TableReader t(*each, "a top level", r.errors);
    TopLevelDescription top;
    top.where = each->where;
    top.slot = read_slot(t);
    top.name = t.text("name", "top level");
    for (const Value* instance : t.tables("instance")) top.instances.push_back(read_instance(r, *instance));
    t.finish();
    r.out.top_levels.push_back(std::move(top));
  }
  check_names(r);
}

}  // namespace glint::pipeline
