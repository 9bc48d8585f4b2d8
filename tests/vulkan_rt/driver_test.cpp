// Tests the recorded conformance set through the Vulkan driver: an application of the loader traces every
// ray.
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <initializer_list>
#include <iostream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/catch.h"
#include "tests/vulkan/ray_pipeline_client.h"
#include "tests/vulkan_rt/compare.h"
#include "tests/vulkan_rt/conformance_world.h"

namespace glint::vulkan_rt {
namespace {

using test::MappedBuffer;
using test::RayStructure;

constexpr uint32_t kRecordStride = 64;  // a handle and the data

std::string text_of(const std::filesystem::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Is the application that recorded the set, on the driver under test.
class RecordingClient : public test::RayPipelineClient {
 public:
  explicit RecordingClient(const Recording& r) : recording_(r) {
    pipeline_layout = layout(5);
    vertices_ = upload(r.vertices), spheres_ = upload(r.spheres), rays_ = upload(r.rays);
    records_ = upload(std::vector<Record>(r.rays_per_pattern));
    build_scene();
    build_pipeline();
    set_ = ray_set(set_layout, top_,
                   {records_.buffer, vertices_.buffer, spheres_.buffer, rays_.buffer, records_.buffer});
  }

  std::vector<Record> run_mode(const Mode& mode) {
    const uint32_t push[10] = {mode.ray_flags,
                               mode.mask,
                               mode.sbt_offset,
                               mode.sbt_stride,
                               mode.miss_index,
                               mode.any_hit_mode,
                               mode.pattern * recording_.rays_per_pattern,
                               0,
                               mode.callable,
                               0};
    std::memset(records_.data, 0, records_.bytes);
    test::check(run([&](VkCommandBuffer commands) {
                  bind(commands, pipeline_, set_);
                  vkCmdPushConstants(commands, pipeline_layout, test::kAllRayStages, 0, sizeof push, push);
                  cmd_trace(commands, &raygen_, &miss_, &hit_, &callable_, recording_.rays_per_pattern, 1, 1);
                }),
                "the launch of " + mode.name);
    const auto all = records_.as<Record>();
    return {all.begin(), all.begin() + recording_.rays_per_pattern};
  }

 private:
  template <class T>
  MappedBuffer upload(const std::vector<T>& values) {
    const MappedBuffer out = buffer_with_address(values.size() * sizeof(T));
    std::memcpy(out.data, values.data(), values.size() * sizeof(T));
    return out;
  }

  test::BuildOrder order_of(const std::vector<Geometry>& geometries) {
    test::BuildOrder order;
    for (const Geometry& g : geometries) {
      VkGeometryFlagsKHR flags = VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR;
      if (g.opaque) flags |= VK_GEOMETRY_OPAQUE_BIT_KHR;
      test::BuildOrder one;
      if (g.triangles) {
        test::Corners corners;
        for (uint32_t i = 0; i < g.count * 3; ++i) {
          const auto& v = recording_.vertices[g.first_vertex + i];
          corners.push_back({v[0], v[1], v[2]});
        }
        one = triangles(corners, false, flags);
      } else {
        std::vector<VkAabbPositionsKHR> all;
        for (uint32_t i = 0; i < g.count; ++i) {
          const auto& s = recording_.spheres[i];
          all.push_back({s[0] - s[3], s[1] - s[3], s[2] - s[3], s[0] + s[3], s[1] + s[3], s[2] + s[3]});
        }
        one = boxes(all);
        one.geometries[0].flags = flags;
      }
      order.geometries.push_back(one.geometries[0]);
      order.ranges.push_back(one.ranges[0]);
    }
    return order;
  }

  void build_scene() {
    std::vector<VkDeviceAddress> bottoms;
    for (const auto& geometries : recording_.bottoms) bottoms.push_back(build(order_of(geometries)).address);
    std::vector<VkAccelerationStructureInstanceKHR> all;
    for (const Instance& i : recording_.instances) {
      VkAccelerationStructureInstanceKHR& to = all.emplace_back();
      std::memcpy(&to.transform, i.transform.data(), sizeof to.transform);
      to.instanceCustomIndex = i.custom & 0xff'ffff, to.mask = i.mask & 0xff;
      to.instanceShaderBindingTableRecordOffset = i.sbt_offset & 0xff'ffff, to.flags = i.flags & 0xff;
      to.accelerationStructureReference = bottoms.at(i.bottom);
    }
    top_ = build(instances(all));
  }

  void build_pipeline() {
    test::RayPipelineOrder order;
    for (const auto& [stage, file] : std::initializer_list<std::pair<VkShaderStageFlagBits, const char*>>{
             {VK_SHADER_STAGE_RAYGEN_BIT_KHR, "rec.rgen"},
             {VK_SHADER_STAGE_MISS_BIT_KHR, "rec.rmiss"},
             {VK_SHADER_STAGE_MISS_BIT_KHR, "rec2.rmiss"},
             {VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, "rec_tri.rchit"},
             {VK_SHADER_STAGE_ANY_HIT_BIT_KHR, "tri.rahit"},
             {VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, "rec_sph.rchit"},
             {VK_SHADER_STAGE_ANY_HIT_BIT_KHR, "sph.rahit"},
             {VK_SHADER_STAGE_INTERSECTION_BIT_KHR, "sph.rint"},
             {VK_SHADER_STAGE_CALLABLE_BIT_KHR, "c0.rcall"},
             {VK_SHADER_STAGE_CALLABLE_BIT_KHR, "c1.rcall"}})
      order.shaders.push_back({stage, text_of(recording_.folder / "shaders" / file),
                               (recording_.folder / "shaders" / file).string()});
    constexpr uint32_t kNone = VK_SHADER_UNUSED_KHR;
    order.groups = {{0}, {1}, {2}, {kNone, 3, 4}, {kNone, 5, 6, 7}, {8}, {9}};
    order.depth = 8;
    pipeline_ = ray_pipeline(order);
    fill_table();
  }

  void fill_table() {
    table_ = buffer(4096,
                    VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR);
    const std::vector<uint8_t> all = handles(pipeline_, 7);
    VkDeviceSize end = 0;
    const auto put = [&](uint32_t group, const RecordData& data) {
      auto* const at = static_cast<std::byte*>(table_.data) + end;
      std::memcpy(at, all.data() + group * 32, 32);
      std::memcpy(at + 32, &data, sizeof data);
      end += kRecordStride;
    };
    const auto region = [&](VkDeviceSize from) {
      return VkStridedDeviceAddressRegionKHR{address(table_) + from, kRecordStride, end - from};
    };
    put(0, {});
    raygen_ = region(0);
    put(1, {}), put(2, {});
    miss_ = region(kRecordStride);
    const VkDeviceSize hits = end;
    for (size_t i = 0; i < hit_records().size(); ++i) put(i % 5 == 3 ? 4 : 3, hit_records()[i]);
    hit_ = region(hits);
    const VkDeviceSize callables = end;
    put(5, {3000, 0, 0, 0, {}}), put(6, {3001, 0, 0, 0, {}});
    callable_ = region(callables);
  }

  const Recording& recording_;
  MappedBuffer vertices_, spheres_, rays_, records_, table_;
  RayStructure top_;
  VkPipeline pipeline_ = nullptr;
  VkDescriptorSet set_ = nullptr;
  VkStridedDeviceAddressRegionKHR raygen_{}, miss_{}, hit_{}, callable_{};
};

TEST_CASE(
    "every recorded ray of every mode finds the same through the driver, or a checked rule says why not") {
  if (!has_recording()) {
    std::cout << "SKIPPED: no recording in " << recording_folder()
              << "; GLINT_VULKAN_RT_DIR names another folder\n";
    return;
  }
  const Recording& r = recording();
  REQUIRE(r.first_launch_index == 0);
  RecordingClient client(r);
  uint32_t rays = 0;
  for (size_t m = 0; m < r.modes.size(); ++m) {
    const std::vector<Record> ours = client.run_mode(r.modes[m]);
    const Tally tally = compare(r, r.modes[m], ours.data(), r.records.data() + m * r.rays_per_pattern);
    std::cout << fmt::format("driver     {}\n", tally.line(r.modes[m].name));
    INFO(tally.line(r.modes[m].name) << tally.first_different);
    CHECK(tally.different == 0);
    rays += tally.rays;
    // Which hit comes first depends on the preset.
    if ((r.modes[m].ray_flags & 4) || r.modes[m].any_hit_mode == 3) continue;
    const std::vector<Record> direct = vulkan_rt::run_mode(r, r.modes[m], "immediate");
    CHECK(std::memcmp(ours.data(), direct.data(), ours.size() * sizeof ours[0]) == 0);
  }
  CHECK(rays == r.modes.size() * r.rays_per_pattern);
  CHECK(client.messages.empty());
}

}  // namespace
}  // namespace glint::vulkan_rt
