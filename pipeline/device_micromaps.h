// Builds opacity micromaps from memory of a program or of the host, and reads them for geometries, in
// Vulkan's forms (VK_EXT_opacity_micromap).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/types.h"
#include "rtunit/structure/micromaps.h"

namespace glint::pipeline {

// Is VkMicromapTriangleEXT as it lies in memory: one map of an array of them.
struct MicromapTriangle {
  uint32_t offset = 0;  // bytes from the start of the data to the map's states
  uint16_t level = 0;
  uint16_t format = 0;  // VkOpacityMicromapFormatEXT
};
static_assert(sizeof(MicromapTriangle) == 8);

// Says how many maps of a kind there are, as VkMicromapUsageEXT does.
struct MicromapUsage {
  uint32_t count = 0, level = 0, format = 0;
};

// Returns the format of a kind of maps. Throws UserError for one that is not there.
rt::MicromapFormat micromap_format(uint32_t level, uint32_t format);
// Returns a format in which maps of both can be written without a loss.
rt::MicromapFormat common_format(const rt::MicromapFormat& a, const rt::MicromapFormat& b);

// Returns the host's bytes at an address, or null where they are not all there.
using FindBytes = std::function<const std::byte*(Address at, uint64_t bytes)>;

// Holds an array of micromaps in bytes that need nothing else: this header, the triangles, with offsets from
// the end of the triangles on, and the states.
struct MicromapArray {
  static constexpr uint32_t kMagic = 0x4d4d4c47;  // "GLMM"
  uint32_t magic = kMagic;
  uint32_t count = 0;
  uint64_t bytes = 0;  // of all
};

// Returns the bytes that an array of so many maps takes.
uint64_t micromap_bytes(std::span<const MicromapUsage> usage);
// Encodes `count` maps, whose triangles lie `stride` bytes apart. Throws UserError for what lies outside of
// memory, and for formats that are not there.
std::vector<std::byte> encode_micromaps(const FindBytes& find, Address triangles, uint64_t stride,
                                        uint32_t count, Address data);
// Returns the array that begins at `from`, or nothing where no whole one is.
std::span<const std::byte> micromap_array_at(const FindBytes& find, Address from);

// Corresponds to VkAccelerationStructureTrianglesOpacityMicromapEXT.
struct DeviceMicromaps {
  uint32_t index_bytes = 0;  // 2 or 4; 0: the index of a triangle is its number
  Address indices = 0;
  uint64_t stride = 0;                 // bytes from one index to the next
  uint32_t base = 0;                   // is added to every index that is not special
  FindBytes find_indices;              // the memory that has the indices
  std::span<const std::byte> array{};  // micromap_array_at(); empty: all indices are special
};

// Holds the maps that a geometry's triangles name, which may differ in their formats.
struct TakenMicromaps {
  std::vector<int32_t> index;  // as rt::Micromaps::index
  struct Map {
    rt::MicromapFormat format;
    std::span<const std::byte> states;
  };
  std::vector<Map> maps;
  uint64_t unread = 0;  // triangles whose index or map is not there; their any-hit shaders decide
};
TakenMicromaps take_micromaps(const DeviceMicromaps& from, uint32_t triangles);

// Writes maps in a format that can hold all of them. They come first, as in Vulkan.
rt::Micromaps in_format(const TakenMicromaps& from, const rt::MicromapFormat& format);

}  // namespace glint::pipeline
