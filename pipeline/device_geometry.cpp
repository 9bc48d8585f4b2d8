// Reads vertices, indices, transforms and boxes where a program has put them.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/device_geometry.h"

#include <cstddef>
#include <cstring>
#include <fmt/format.h>
#include <limits>
#include <span>
#include <utility>

namespace glint::pipeline {
namespace {

constexpr float kNotThere = std::numeric_limits<float>::quiet_NaN();  // makes a primitive inactive

}  // namespace

// Returns the number of the vertex at a corner.
std::optional<uint64_t> DeviceGeometry::vertex_of(const DeviceTriangles& from, uint64_t corner) const {
  if (from.index_bytes == 0) return corner + from.first_vertex;
  uint32_t index = 0;
  const std::byte* const at = find(from.indices + corner * from.index_bytes, from.index_bytes);
  if (!at) return {};
  std::memcpy(&index, at, from.index_bytes);
  return uint64_t{index} + from.first_vertex;
}

std::optional<DeviceGeometry::Position> DeviceGeometry::position_at(const DeviceTriangles& from,
                                                                    Address at) const {
  Position out{};
  const std::byte* const bytes = find(at, from.format ? exec::info_of(*from.format).bytes : sizeof out);
  if (!bytes) return {};
  if (!from.format) {
    std::memcpy(out.data(), bytes, sizeof out);
    return out;
  }
  const exec::Words words = exec::decode(*from.format, bytes);
  for (size_t i = 0; i < 3; ++i) out[i] = exec::float_of(words[i]);
  return out;
}

void DeviceGeometry::note_unread(uint64_t unread, const char* what) {
  if (unread)
    notes_.push_back(fmt::format("geometry {}: {} {} lie outside of memory and are inactive",
                                 level_.geometries.size(), unread, what));
}

void DeviceGeometry::add(const DeviceTriangles& from) {
  std::vector<Position>& positions = positions_.emplace_back();
  positions.reserve(uint64_t{from.count} * 3);
  uint64_t unread = 0;
  for (uint64_t triangle = 0; triangle < from.count; ++triangle) {
    bool is_whole = true;
    for (uint64_t corner = 3 * triangle; corner < 3 * triangle + 3; ++corner) {
      const auto vertex = vertex_of(from, corner);
      const auto position = vertex ? position_at(from, from.vertices + *vertex * from.stride) : std::nullopt;
      is_whole &= position.has_value();
      positions.push_back(position.value_or(Position{kNotThere, kNotThere, kNotThere}));
    }
    unread += !is_whole;
  }
  note_unread(unread, "triangles");
  rt::Geometry geometry;
  geometry.positions = std::as_bytes(std::span(positions));
  geometry.opaque = from.opaque, geometry.no_duplicate_any_hit = from.no_duplicate_any_hit;
  if (from.transform) {
    if (const std::byte* const at = find(from.transform, sizeof geometry.transform))
      std::memcpy(geometry.transform.data(), at, sizeof geometry.transform);
    else
      notes_.push_back(fmt::format("geometry {}: its transform lies outside of memory: {}",
                                   level_.geometries.size(),
                                   memory_->explain(from.transform, sizeof geometry.transform)));
  }
  if (from.micromaps) {
    TakenMicromaps taken = take_micromaps(*from.micromaps, from.count);
    if (taken.unread)
      notes_.push_back(fmt::format(
          "geometry {}: {} triangles have no micromap, because their index or their map is not there",
          level_.geometries.size(), taken.unread));
    micromaps_.add(level_.geometries.size(), std::move(taken));
  }
  level_.geometries.push_back(geometry);
}

void DeviceGeometry::finish() {
  micromaps_.give_to(level_);
}

void DeviceGeometry::add(const DeviceBoxes& from) {
  std::vector<rt::Bounds>& boxes = boxes_.emplace_back();
  uint64_t unread = 0;
  for (uint64_t i = 0; i < from.count; ++i) {
    rt::Bounds& box = boxes.emplace_back();
    const std::byte* const at = find(from.boxes + i * from.stride, sizeof box);
    if (at)
      std::memcpy(&box, at, sizeof box);
    else
      box.low[0] = kNotThere, ++unread;
  }
  note_unread(unread, "boxes");
  rt::Geometry geometry;
  geometry.aabbs = boxes;
  geometry.opaque = from.opaque, geometry.no_duplicate_any_hit = from.no_duplicate_any_hit;
  level_.geometries.push_back(geometry);
}

}  // namespace glint::pipeline
