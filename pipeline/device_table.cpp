// Turns handles in memory into the shaders that records call.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/device_table.h"

#include <cstring>
#include <fmt/format.h>
#include <optional>

#include "base/diagnostics.h"

namespace glint::pipeline {
namespace {

using exec::kForeignShader, exec::kHandleBytes, exec::kNoShader;
using isa::Stage;

// Holds what the 32 bytes of a handle say.
struct HandleContents {
  uint32_t group_plus_one = 0;
  uint32_t zero = 0;
  uint64_t pipeline = 0;
  std::array<char, 16> mark{'G', 'l', 'i', 'n', 't', ' ', 'g', 'r', 'o', 'u', 'p'};
};
static_assert(sizeof(HandleContents) == kHandleBytes);

class DeviceTableReader {
 public:
  DeviceTableReader(const exec::Image& image, const mem::AddressSpace& memory,
                    std::span<const ShaderGroup> groups, uint64_t pipeline)
      : image_(image), memory_(memory), groups_(groups), pipeline_(pipeline) {}

  static exec::RecordRegion region_of(const DeviceRegion& region, const char* name) {
    if (region.stride % kHandleAlignment || region.stride > kMaxStride)
      throw UserError(
          fmt::format("the stride of the {} region is {}: it must be a multiple of {} and at most {}", name,
                      region.stride, kHandleAlignment, kMaxStride));
    return {region.base, uint32_t(region.stride)};
  }

  uint32_t raygen(const DeviceRegion& region) const {
    const uint32_t shader = general(region.base, Stage::RayGeneration);
    if (shader == kForeignShader || shader == kNoShader)
      throw UserError(
          {},
          fmt::format("the record of ray generation at address {:#x} holds no ray generation group of the "
                      "pipeline",
                      region.base),
          "copy the handle that the pipeline returned for the group there");
    return shader;
  }

  std::vector<uint32_t> generals(const DeviceRegion& region, Stage stage) const {
    std::vector<uint32_t> out;
    for (uint64_t i = 0; i < count_of(region); ++i)
      out.push_back(general(region.base + i * region.stride, stage));
    return out;
  }

  std::vector<exec::HitGroup> hit_groups(const DeviceRegion& region) const {
    std::vector<exec::HitGroup> out;
    for (uint64_t i = 0; i < count_of(region); ++i) out.push_back(hit_group(region.base + i * region.stride));
    return out;
  }

 private:
  // The last record may be shorter than the stride.
  static uint64_t count_of(const DeviceRegion& region) {
    if (region.base == 0 || region.bytes < kHandleBytes) return 0;
    return region.stride ? (region.bytes - kHandleBytes) / region.stride + 1 : 1;
  }

  // Says what the handle at an address is: all zeros, a group of the pipeline, or neither.
  struct Found {
    bool is_null = false;
    const ShaderGroup* group = nullptr;
  };
  Found find(Address at) const {
    const std::byte* const bytes = memory_.find(at, kHandleBytes);
    if (!bytes) return {};
    GroupHandle handle;
    std::memcpy(handle.data(), bytes, handle.size());
    if (handle == GroupHandle{}) return {.is_null = true};
    HandleContents contents;
    std::memcpy(&contents, bytes, sizeof contents);
    const uint32_t group = contents.group_plus_one - 1;
    if (group >= groups_.size() || handle != group_handle(pipeline_, group)) return {};
    return {.group = &groups_[group]};
  }

  uint32_t general(Address at, Stage stage) const {
    const auto [is_null, group] = find(at);
    if (is_null) return kNoShader;
    const bool fits =
        group && group->general < image_.shaders.size() && image_.shaders[group->general].stage == stage;
    return fits ? group->general : kForeignShader;
  }

  exec::HitGroup hit_group(Address at) const {
    const auto [is_null, group] = find(at);
    if (is_null) return {};
    return group && group->general == kNoShader ? group->hit : exec::HitGroup{.closest_hit = kForeignShader};
  }

  const exec::Image& image_;
  const mem::AddressSpace& memory_;
  std::span<const ShaderGroup> groups_;
  uint64_t pipeline_;
};

}  // namespace

GroupHandle group_handle(uint64_t pipeline, uint32_t group) {
  HandleContents contents;
  contents.group_plus_one = group + 1;
  contents.pipeline = pipeline;
  GroupHandle out;
  std::memcpy(out.data(), &contents, sizeof contents);
  return out;
}

void read_binding_table(exec::World& world, const mem::AddressSpace& memory, const DeviceTable& table,
                        std::span<const ShaderGroup> groups, uint64_t pipeline) {
  const DeviceTableReader reader(*world.image, memory, groups, pipeline);
  world.table = {table.raygen.base, DeviceTableReader::region_of(table.miss, "miss"),
                 DeviceTableReader::region_of(table.hit, "hit"),
                 DeviceTableReader::region_of(table.callable, "callable")};
  world.raygen = reader.raygen(table.raygen);
  world.miss = reader.generals(table.miss, Stage::Miss);
  world.hit = reader.hit_groups(table.hit);
  world.callable = reader.generals(table.callable, Stage::Callable);
}

}  // namespace glint::pipeline
