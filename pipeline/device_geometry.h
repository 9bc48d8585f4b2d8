// Reads the geometry of an acceleration structure from memory of a program or of the host, in Vulkan's forms.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "exec/texture_format.h"
#include "memsys/address_space.h"
#include "pipeline/device_micromaps.h"
#include "pipeline/level_micromaps.h"
#include "rtunit/structure/build.h"

namespace glint::pipeline {

// Corresponds to VkAccelerationStructureGeometryTrianglesDataKHR with its range: primitiveOffset is added to
// `indices`, or to `vertices` without them, and transformOffset to `transform`.
struct DeviceTriangles {
  // The format of positions: any with floats of one to four channels. Empty means R32G32B32_SFLOAT. A third
  // channel that is missing is 0.
  std::optional<exec::TexelFormat> format{};
  Address vertices = 0;
  uint64_t stride = 12;      // bytes
  uint32_t index_bytes = 0;  // 1, 2 or 4; 0: there are no indices
  Address indices = 0;
  uint32_t first_vertex = 0;  // is added to every index
  Address transform = 0;      // row-major 3x4; 0: there is none
  uint32_t count = 0;         // triangles
  bool opaque = true, no_duplicate_any_hit = false;
  std::optional<DeviceMicromaps> micromaps{};
};

// Corresponds to VkAccelerationStructureGeometryAabbsDataKHR with its range.
struct DeviceBoxes {
  Address boxes = 0;  // six floats each: the lower corner, then the upper one
  uint64_t stride = 24;
  uint32_t count = 0;
  bool opaque = true, no_duplicate_any_hit = false;
};

// Collects the geometries of a bottom level. What cannot be read is inactive and noted.
class DeviceGeometry {
 public:
  explicit DeviceGeometry(const mem::AddressSpace& memory) : memory_(&memory) {}
  // The addresses are pointers of the host, which has all bytes that the geometry names.
  DeviceGeometry() = default;

  void add(const DeviceTriangles& triangles);
  void add(const DeviceBoxes& boxes);
  // Writes the micromaps of all geometries in one format, after the last add(). Choice: a structure has maps
  // of one format, into which coarser maps and those with fewer states are written without a loss.
  void finish();

  // Returns the geometries in the order in which they came. They live as long as this object.
  const rt::BottomLevel& level() const { return level_; }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  using Position = std::array<float, 3>;
  const std::byte* find(Address at, uint64_t bytes) const {
    return memory_ ? memory_->find(at, bytes) : reinterpret_cast<const std::byte*>(at);
  }
  std::optional<uint64_t> vertex_of(const DeviceTriangles& from, uint64_t corner) const;
  std::optional<Position> position_at(const DeviceTriangles& from, Address at) const;
  void note_unread(uint64_t unread, const char* what);

  const mem::AddressSpace* memory_ = nullptr;  // null: the host's
  rt::BottomLevel level_;
  std::deque<std::vector<Position>> positions_;  // of each geometry of triangles
  std::deque<std::vector<rt::Bounds>> boxes_;
  LevelMicromaps micromaps_;
  std::vector<std::string> notes_;
};

}  // namespace glint::pipeline
