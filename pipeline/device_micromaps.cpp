// Packs maps into arrays, and writes those of a geometry in one format.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/device_micromaps.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <optional>

#include "base/diagnostics.h"

namespace glint::pipeline {
namespace {

constexpr uint32_t k2States = 1, k4States = 2;  // VkOpacityMicromapFormatEXT

// Returns the index of a triangle as it was written, sign-extended, or nothing where it is not in memory.
// Special indices are below 0.
std::optional<int64_t> index_at(const DeviceMicromaps& from, uint64_t triangle) {
  if (from.index_bytes == 0) return int64_t(triangle);
  const std::byte* const at = from.find_indices(from.indices + triangle * from.stride, from.index_bytes);
  if (!at) return {};
  uint32_t value = 0;
  std::memcpy(&value, at, from.index_bytes);
  const int64_t all = (int64_t{1} << 8 * from.index_bytes) - 1;
  return value > all - 4 ? int64_t{value} - all - 1 : int64_t{value};
}

// Returns the map of an array at an index, or nothing where the array has none.
std::optional<TakenMicromaps::Map> map_at(std::span<const std::byte> array, int64_t index) {
  if (array.empty()) return {};
  const auto header = rt::load<MicromapArray>(array.data());
  if (index < 0 || index >= int64_t{header.count}) return {};
  const auto triangle =
      rt::load<MicromapTriangle>(array.data() + sizeof header + size_t(index) * sizeof(MicromapTriangle));
  if (triangle.level > rt::MicromapFormat::kMostLevels) return {};
  const rt::MicromapFormat format{triangle.format == k2States, triangle.level};
  const uint64_t first = sizeof header + uint64_t{header.count} * sizeof(MicromapTriangle) + triangle.offset;
  if (first > array.size() || format.bytes() > array.size() - first) return {};
  return TakenMicromaps::Map{format, array.subspan(size_t(first), format.bytes())};
}

// Writes a map at the end of `to`. A part of the coarser map is as many parts of the finer one, which follow
// each other.
void append(const TakenMicromaps::Map& from, const rt::MicromapFormat& format, std::vector<uint8_t>& to) {
  const auto* const states = reinterpret_cast<const uint8_t*>(from.states.data());
  if (from.format == format) {
    to.insert(to.end(), states, states + format.bytes());
    return;
  }
  const size_t first = to.size();
  to.resize(first + format.bytes());
  const uint32_t shift = 2 * (format.level - from.format.level);
  for (uint32_t i = 0; i < format.num_states(); ++i) {
    const auto state = uint32_t(rt::micro_state(from.format, states, i >> shift));
    const uint32_t bit = i * format.bits();
    to[first + bit / 8] = uint8_t(to[first + bit / 8] | state << bit % 8);
  }
}

}  // namespace

rt::MicromapFormat micromap_format(uint32_t level, uint32_t format) {
  if (format != k2States && format != k4States)
    throw UserError(fmt::format("a micromap has format {}, and there are {} (2 states) and {} (4 states)",
                                format, k2States, k4States));
  if (level > rt::MicromapFormat::kMostLevels)
    throw UserError(fmt::format("a micromap has subdivision level {}, and there are 0 to {}", level,
                                rt::MicromapFormat::kMostLevels));
  return {format == k2States, level};
}

rt::MicromapFormat common_format(const rt::MicromapFormat& a, const rt::MicromapFormat& b) {
  return {a.two_states && b.two_states, std::max(a.level, b.level)};
}

uint64_t micromap_bytes(std::span<const MicromapUsage> usage) {
  uint64_t out = sizeof(MicromapArray);
  for (const MicromapUsage& each : usage)
    out +=
        uint64_t{each.count} * (sizeof(MicromapTriangle) + micromap_format(each.level, each.format).bytes());
  return out;
}

std::vector<std::byte> encode_micromaps(const FindBytes& find, Address triangles, uint64_t stride,
                                        uint32_t count, Address data) {
  const uint64_t first = sizeof(MicromapArray) + uint64_t{count} * sizeof(MicromapTriangle);
  std::vector<std::byte> out(first);
  for (uint64_t i = 0; i < count; ++i) {
    const std::byte* const at = find(triangles + i * stride, sizeof(MicromapTriangle));
    if (!at) throw UserError(fmt::format("triangle {} of {} of a micromap is not in memory", i, count));
    auto triangle = rt::load<MicromapTriangle>(at);
    const uint32_t bytes = micromap_format(triangle.level, triangle.format).bytes();
    const std::byte* const states = find(data + triangle.offset, bytes);
    if (!states)
      throw UserError(
          fmt::format("{} bytes of states of triangle {} of a micromap are not in memory", bytes, i));
    if ((out.size() - first) >> 32) throw UserError("the states of a micromap have more than 4 GiB");
    triangle.offset = uint32_t(out.size() - first);
    std::memcpy(out.data() + sizeof(MicromapArray) + i * sizeof triangle, &triangle, sizeof triangle);
    out.insert(out.end(), states, states + bytes);
  }
  const MicromapArray header{MicromapArray::kMagic, count, out.size()};
  std::memcpy(out.data(), &header, sizeof header);
  return out;
}

std::span<const std::byte> micromap_array_at(const FindBytes& find, Address from) {
  const std::byte* const at = find(from, sizeof(MicromapArray));
  if (!at) return {};
  const auto header = rt::load<MicromapArray>(at);
  const uint64_t least = sizeof header + uint64_t{header.count} * sizeof(MicromapTriangle);
  if (header.magic != MicromapArray::kMagic || header.bytes < least || !find(from, header.bytes)) return {};
  return {at, size_t(header.bytes)};
}

TakenMicromaps take_micromaps(const DeviceMicromaps& from, uint32_t triangles) {
  TakenMicromaps out;
  const uint64_t most = from.array.empty() ? 0 : rt::load<MicromapArray>(from.array.data()).count;
  std::vector<int32_t> number(size_t(most), -1);  // of each map of the array among those that are taken
  out.index.reserve(triangles);
  for (uint32_t i = 0; i < triangles; ++i) {
    const std::optional<int64_t> index = index_at(from, i);
    if (index && *index < 0) {
      out.index.push_back(int32_t(*index));
      continue;
    }
    const int64_t which = index.value_or(0) + from.base;
    const auto map = index ? map_at(from.array, which) : std::nullopt;
    if (!map) {
      ++out.unread;
      out.index.push_back(rt::Micromaps::uniform(rt::MicroState::UnknownOpaque));
      continue;
    }
    int32_t& known = number[size_t(which)];
    if (known < 0) known = int32_t(out.maps.size()), out.maps.push_back(*map);
    out.index.push_back(known);
  }
  return out;
}

rt::Micromaps in_format(const TakenMicromaps& from, const rt::MicromapFormat& format) {
  rt::Micromaps out{format, from.index, {}, true};
  out.states.reserve(from.maps.size() * format.bytes());
  for (const TakenMicromaps::Map& each : from.maps) append(each, format, out.states);
  return out;
}

}  // namespace glint::pipeline
