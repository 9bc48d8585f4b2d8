// Tests opacity micromaps: what rays meet with them is what an any-hit test of the same pattern says, and
// only what a map does not know is asked of a shader (VK_EXT_opacity_micromap).
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/catch.h"
#include "tests/vulkan/ray_client.h"

namespace glint::test::micromap_test {
namespace {

constexpr uint16_t k2States = VK_OPACITY_MICROMAP_FORMAT_2_STATE_EXT,
                   k4States = VK_OPACITY_MICROMAP_FORMAT_4_STATE_EXT;
constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr uint32_t kSquares = 4, kRays = kSquares * 16 * 16;

struct Wanted {
  Wanted() {
    maps.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_OPACITY_MICROMAP_FEATURES_EXT;
    maps.micromap = maps.micromapHostCommands = VK_TRUE;
  }
  VkPhysicalDeviceOpacityMicromapFeaturesEXT maps{};
};

// Is one map: a state for each part, in the order of the specification.
struct Map {
  uint16_t level = 0, format = k4States;
  std::vector<uint32_t> states;
};

// Returns a map whose states look like any.
Map any_map(uint16_t level, uint16_t format, uint32_t seed) {
  Map out{level, format, {}};
  for (uint32_t i = 0; i < 1u << 2 * level; ++i) {
    seed = seed * 1664525 + 1013904223;
    out.states.push_back((seed >> 16) % (format == k2States ? 2 : 4));
  }
  return out;
}

struct Bytes {
  std::vector<uint8_t> data;
  std::vector<VkMicromapTriangleEXT> triangles;
  std::vector<VkMicromapUsageEXT> usage;
};

Bytes bytes_of(const std::vector<Map>& maps) {
  Bytes out;
  for (const Map& each : maps) {
    const uint32_t bits = each.format == k2States ? 1 : 2;
    out.triangles.push_back({uint32_t(out.data.size()), each.level, each.format});
    out.usage.push_back({1, each.level, each.format});
    std::vector<uint8_t> packed((each.states.size() * bits + 7) / 8);
    for (size_t i = 0; i < each.states.size(); ++i)
      packed[i * bits / 8] = uint8_t(packed[i * bits / 8] | each.states[i] << i * bits % 8);
    out.data.insert(out.data.end(), packed.begin(), packed.end());
  }
  return out;
}

class MapClient : private Wanted, public RayClient {
 public:
  MapClient() : RayClient({VK_EXT_OPACITY_MICROMAP_EXTENSION_NAME}, &this->maps) {}

  VkMicromapEXT micromap(VkDeviceSize bytes) {
    const MappedBuffer storage = buffer_with_address(bytes);
    VkMicromapCreateInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_MICROMAP_CREATE_INFO_EXT;
    info.buffer = storage.buffer, info.size = bytes, info.type = VK_MICROMAP_TYPE_OPACITY_MICROMAP_EXT;
    VkMicromapEXT out = nullptr;
    check(load<PFN_vkCreateMicromapEXT>("vkCreateMicromapEXT")(device, &info, nullptr, &out),
          "vkCreateMicromapEXT");
    at_end([this, out] { load<PFN_vkDestroyMicromapEXT>("vkDestroyMicromapEXT")(device, out, nullptr); });
    return out;
  }

  VkMicromapBuildInfoEXT info_of(const Bytes& bytes) const {
    VkMicromapBuildInfoEXT out{};
    out.sType = VK_STRUCTURE_TYPE_MICROMAP_BUILD_INFO_EXT, out.type = VK_MICROMAP_TYPE_OPACITY_MICROMAP_EXT;
    out.usageCountsCount = uint32_t(bytes.usage.size()), out.pUsageCounts = bytes.usage.data();
    out.triangleArrayStride = sizeof(VkMicromapTriangleEXT);
    return out;
  }
  VkDeviceSize size_of(const Bytes& bytes) {
    const VkMicromapBuildInfoEXT info = info_of(bytes);
    VkMicromapBuildSizesInfoEXT out{VK_STRUCTURE_TYPE_MICROMAP_BUILD_SIZES_INFO_EXT, nullptr, 0, 0, VK_FALSE};
    load<PFN_vkGetMicromapBuildSizesEXT>("vkGetMicromapBuildSizesEXT")(
        device, VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, &out);
    return out.micromapSize;
  }
  using RayClient::size_of;

  VkResult build(const Bytes& bytes, VkMicromapEXT to) {
    const MappedBuffer data = filled(bytes.data), triangles = filled(bytes.triangles);
    VkMicromapBuildInfoEXT info = info_of(bytes);
    info.dstMicromap = to, info.data.deviceAddress = address(data);
    info.triangleArray.deviceAddress = address(triangles);
    info.scratchData.deviceAddress = address(data);
    return run([&](VkCommandBuffer commands) {
      load<PFN_vkCmdBuildMicromapsEXT>("vkCmdBuildMicromapsEXT")(commands, 1, &info);
    });
  }
  VkMicromapEXT built(const std::vector<Map>& all) {
    const Bytes bytes = bytes_of(all);
    const VkMicromapEXT out = micromap(size_of(bytes));
    check(build(bytes, out), "the build of a micromap");
    return out;
  }
  using RayClient::build;

  template <class T>
  MappedBuffer filled(const std::vector<T>& values) {
    const MappedBuffer out = buffer_with_address(std::max<size_t>(values.size() * sizeof(T), 64));
    std::memcpy(out.data, values.data(), values.size() * sizeof(T));
    return out;
  }
};

// The eight triangles of the squares have these maps. Below zero they are special indices.
const std::vector<int16_t> kIndices{0, 1, -1, -2, -3, -4, 2, 0};
const std::vector<Map>& pattern() {
  static const std::vector<Map> maps{any_map(3, k4States, 1), any_map(1, k2States, 5),
                                     any_map(5, k4States, 9)};
  return maps;
}

Corners squares() {
  Corners out;
  for (uint32_t i = 0; i < kSquares; ++i)
    for (const auto& corner : unit_square()) out.push_back({corner[0] + float(i), corner[1], corner[2]});
  return out;
}

// The states of a triangle begin at first[triangle], and its map has levels[triangle]. A shader finds a state
// by going from part to part (Vulkan, "Ray Opacity Micromap"): the part nearest to corner 0, the middle, that
// at corner 1, that at corner 2. In the middle and in the last part the first two corners change places.
const std::string kShader = R"(#version 460
#extension GL_EXT_ray_query : require
#extension GL_EXT_opacity_micromap : require
layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1) buffer Out { uint v[]; };
layout(set = 0, binding = 2) buffer States { uint states[]; };
layout(set = 0, binding = 3) buffer About { uvec2 about[]; };
layout(push_constant) uniform Mode { uint flags; uint force; } mode;
float cross2(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }
uint part_at(vec2 uv, uint level) {
  vec2 a = vec2(0), b = vec2(1, 0), c = vec2(0, 1);
  uint part = 0;
  for (uint i = 0; i < level; ++i) {
    vec2 ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
    float area = cross2(b - a, c - a), wb = cross2(uv - a, c - a) / area, wc = cross2(b - a, uv - a) / area;
    part *= 4;
    if (1 - wb - wc >= 0.5) { b = ab; c = ca; }
    else if (wb >= 0.5) { part += 2; a = ab; c = bc; }
    else if (wc >= 0.5) { part += 3; a = bc; b = ca; }
    else { part += 1; a = ca; b = bc; c = ab; }
  }
  return part;
}
void main() {
  uint ray = gl_WorkGroupID.x * 256 + gl_LocalInvocationIndex;
  vec2 at = vec2(gl_WorkGroupID.x, 0) + (vec2(gl_LocalInvocationID.xy) + vec2(0.43, 0.29)) / 16;
  rayQueryEXT query;
  uint flags = mode.flags | (mode.force != 0 ? gl_RayFlagsForceOpacityMicromap2StateEXT : 0);
  rayQueryInitializeEXT(query, scene, flags, 0xff, vec3(at, 5), 0, vec3(0, 0, -1), 100);
  uint asked = 0, state = 0;
  while (rayQueryProceedEXT(query)) {
    uvec2 map = about[rayQueryGetIntersectionPrimitiveIndexEXT(query, false)];
    state = states[map.x + part_at(rayQueryGetIntersectionBarycentricsEXT(query, false), map.y)];
    ++asked;
    bool is_solid = state == 1 || (state > 1 && (gl_LocalInvocationIndex & 1) != 0);
    if (is_solid) rayQueryConfirmIntersectionEXT(query);
  }
  v[ray] = rayQueryGetIntersectionTypeEXT(query, true) | asked << 4 | state << 8;
}
)";

// Is what became of a ray.
struct Found {
  bool hit = false;
  uint32_t asked = 0, state = 0;  // candidates of the shader, and the state of the last one
};

struct Rays {
  explicit Rays(MapClient& of) : client(of), out(of.buffer(kRays * sizeof(uint32_t))) {
    std::vector<uint32_t> states{0, 1, 2, 3}, about;
    for (const int16_t index : kIndices) {
      about.push_back(index < 0 ? uint32_t(-1 - index) : uint32_t(states.size()));
      about.push_back(index < 0 ? 0 : pattern()[size_t(index)].level);
      if (index < 0) continue;
      const auto& map = pattern()[size_t(index)].states;
      states.insert(states.end(), map.begin(), map.end());
    }
    all_states = client.filled(states), all_about = client.filled(about);
    pipeline = client.pipeline(
        kShader, {.bindings = {VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, kStorage, kStorage, kStorage},
                  .push_constant_bytes = 8});
  }
  std::vector<Found> trace(const RayStructure& top, uint32_t flags = 0, bool force = false) {
    const VkDescriptorSet set =
        client.ray_set(pipeline.set_layout, top, {out.buffer, all_states.buffer, all_about.buffer});
    REQUIRE(client.dispatch(pipeline, set, {kSquares, 1, 1}, {flags, force}) == VK_SUCCESS);
    std::vector<Found> found;
    for (uint32_t i = 0; i < kRays; ++i) {
      const uint32_t v = out.as<uint32_t>()[i];
      found.push_back({(v & 15) != 0, v >> 4 & 15, v >> 8});
    }
    return found;
  }

  MapClient& client;
  MappedBuffer out, all_states, all_about;
  ComputePipeline pipeline;
};

// Describes how the geometry names its maps. The indices lie in a buffer of the client.
struct Attached {
  explicit Attached(MapClient& client, VkMicromapEXT micromap) : indices(client.filled(kIndices)) {
    info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_TRIANGLES_OPACITY_MICROMAP_EXT;
    info.indexType = VK_INDEX_TYPE_UINT16, info.indexStride = 2, info.micromap = micromap;
    info.indexBuffer.deviceAddress = client.address(indices);
    for (const int16_t index : kIndices)
      if (index >= 0) usage.push_back({1, pattern()[size_t(index)].level, pattern()[size_t(index)].format});
    info.usageCountsCount = uint32_t(usage.size()), info.pUsageCounts = usage.data();
  }
  MappedBuffer indices;
  std::vector<VkMicromapUsageEXT> usage;
  VkAccelerationStructureTrianglesOpacityMicromapEXT info{};
};

RayStructure top_of(MapClient& client, const RayStructure& bottom, uint32_t instance_flags = 0) {
  auto instance = instance_at(0, 0, bottom.address);
  instance.flags = instance_flags & 0xff;
  return client.build(client.instances({instance}));
}

BuildOrder order_of(MapClient& client, Attached* attached, VkGeometryFlagsKHR flags = 0) {
  BuildOrder out = client.triangles(squares(), false, flags);
  if (attached) out.geometries[0].geometry.triangles.pNext = &attached->info;
  return out;
}

// Requires of each ray what `expected(state, solid)` says. `plain` is what rays find without maps, where a
// shader has seen every state.
void require_each(const std::vector<Found>& plain, const std::vector<Found>& found,
                  const std::function<Found(uint32_t state, bool solid)>& expected) {
  std::array<uint32_t, 4> seen{};
  for (uint32_t i = 0; i < kRays; ++i) {
    REQUIRE(plain[i].asked == 1);
    const Found wanted = expected(plain[i].state, plain[i].hit);
    CAPTURE(i, plain[i].state);
    REQUIRE(found[i].hit == wanted.hit);
    REQUIRE(found[i].asked == wanted.asked);
    if (wanted.asked) REQUIRE(found[i].state == plain[i].state);
    ++seen[plain[i].state];
  }
  for (const uint32_t count : seen) CHECK(count > 100);
}

Found by_map(uint32_t state, bool solid) {
  return {state > 1 ? solid : state == 1, state > 1};
}
Found by_two_states(uint32_t state, bool) {
  return {state % 2 == 1, 0};
}

TEST_CASE("rays meet what an any-hit test of the same pattern says, and ask a shader of unknown parts only",
          "[micromaps]") {
  MapClient client;
  Rays rays(client);
  const RayStructure plain_bottom = client.build(order_of(client, nullptr));
  const auto plain = rays.trace(top_of(client, plain_bottom));
  Attached attached(client, client.built(pattern()));

  for (const VkGeometryFlagsKHR opaque : {0, int(VK_GEOMETRY_OPAQUE_BIT_KHR)}) {
    const RayStructure bottom = client.build(order_of(client, &attached, opaque));
    const RayStructure top = top_of(client, bottom);
    // A map stands in the place of the geometry's opacity.
    require_each(plain, rays.trace(top), by_map);
    require_each(plain, rays.trace(top, 0, true), by_two_states);
    // gl_RayFlagsOpaqueEXT and gl_RayFlagsNoOpaqueEXT override all but the transparent parts.
    require_each(plain, rays.trace(top, 1), [](uint32_t state, bool) { return Found{state != 0}; });
    require_each(plain, rays.trace(top, 2), [](uint32_t state, bool solid) {
      return Found{solid, state != 0};
    });
    // gl_RayFlagsCullOpaqueEXT and gl_RayFlagsCullNoOpaqueEXT
    require_each(plain, rays.trace(top, 64), [](uint32_t state, bool solid) {
      return Found{state > 1 && solid, state > 1};
    });
    require_each(plain, rays.trace(top, 128), [](uint32_t state, bool) { return Found{state == 1}; });
    require_each(plain,
                 rays.trace(top_of(client, bottom, VK_GEOMETRY_INSTANCE_FORCE_OPACITY_MICROMAP_2_STATE_EXT)),
                 by_two_states);
    require_each(plain, rays.trace(top_of(client, bottom, VK_GEOMETRY_INSTANCE_FORCE_OPAQUE_BIT_KHR)),
                 [](uint32_t state, bool) { return Found{state != 0}; });
    require_each(plain,
                 rays.trace(top_of(client, bottom, VK_GEOMETRY_INSTANCE_DISABLE_OPACITY_MICROMAPS_EXT)),
                 [opaque](uint32_t, bool solid) {
                   return opaque ? Found{true} : Found{solid, 1};
                 });
  }
  CHECK(client.messages.empty());
}

TEST_CASE("micromaps are copied, serialised and read back, and can go when a structure is built") {
  MapClient client;
  Rays rays(client);
  const auto plain = rays.trace(top_of(client, client.build(order_of(client, nullptr))));
  const VkMicromapEXT first = client.built(pattern());
  VkQueryPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, info.queryCount = 1;
  const auto property = [&](VkQueryType type) {
    uint64_t out = 0;
    check(client.load<PFN_vkWriteMicromapsPropertiesEXT>("vkWriteMicromapsPropertiesEXT")(
              client.device, 1, &first, type, sizeof out, &out, sizeof out),
          "vkWriteMicromapsPropertiesEXT");
    info.queryType = type;
    VkQueryPool pool = nullptr;
    check(vkCreateQueryPool(client.device, &info, nullptr, &pool), "vkCreateQueryPool");
    client.at_end([&client, pool] { vkDestroyQueryPool(client.device, pool, nullptr); });
    vkResetQueryPool(client.device, pool, 0, 1);
    check(client.run([&](VkCommandBuffer commands) {
      client.load<PFN_vkCmdWriteMicromapsPropertiesEXT>("vkCmdWriteMicromapsPropertiesEXT")(
          commands, 1, &first, type, pool, 0);
    }),
          "the query");
    uint64_t queried = 0;
    check(vkGetQueryPoolResults(client.device, pool, 0, 1, sizeof queried, &queried, sizeof queried,
                                VK_QUERY_RESULT_WAIT_BIT | VK_QUERY_RESULT_64_BIT),
          "vkGetQueryPoolResults");
    CHECK(queried == out);
    return out;
  };
  const VkMicromapEXT second = client.micromap(property(VK_QUERY_TYPE_MICROMAP_COMPACTED_SIZE_EXT)),
                      third = client.micromap(property(VK_QUERY_TYPE_MICROMAP_COMPACTED_SIZE_EXT));
  const MappedBuffer serial =
      client.buffer_with_address(property(VK_QUERY_TYPE_MICROMAP_SERIALIZATION_SIZE_EXT));
  const VkCopyMicromapInfoEXT copied{VK_STRUCTURE_TYPE_COPY_MICROMAP_INFO_EXT, nullptr, first, second,
                                     VK_COPY_MICROMAP_MODE_COMPACT_EXT};
  VkCopyMicromapToMemoryInfoEXT out{VK_STRUCTURE_TYPE_COPY_MICROMAP_TO_MEMORY_INFO_EXT,
                                    nullptr,
                                    second,
                                    {},
                                    VK_COPY_MICROMAP_MODE_SERIALIZE_EXT};
  out.dst.deviceAddress = client.address(serial);
  VkCopyMemoryToMicromapInfoEXT in{VK_STRUCTURE_TYPE_COPY_MEMORY_TO_MICROMAP_INFO_EXT,
                                   nullptr,
                                   {},
                                   third,
                                   VK_COPY_MICROMAP_MODE_DESERIALIZE_EXT};
  in.src.deviceAddress = client.address(serial);

  REQUIRE(client.run([&](VkCommandBuffer commands) {
    client.load<PFN_vkCmdCopyMicromapEXT>("vkCmdCopyMicromapEXT")(commands, &copied);
    client.load<PFN_vkCmdCopyMicromapToMemoryEXT>("vkCmdCopyMicromapToMemoryEXT")(commands, &out);
    client.load<PFN_vkCmdCopyMemoryToMicromapEXT>("vkCmdCopyMemoryToMicromapEXT")(commands, &in);
  }) == VK_SUCCESS);

  const VkMicromapVersionInfoEXT version{VK_STRUCTURE_TYPE_MICROMAP_VERSION_INFO_EXT, nullptr,
                                         static_cast<uint8_t*>(serial.data)};
  auto compatible = VK_ACCELERATION_STRUCTURE_COMPATIBILITY_INCOMPATIBLE_KHR;
  client.load<PFN_vkGetDeviceMicromapCompatibilityEXT>("vkGetDeviceMicromapCompatibilityEXT")(
      client.device, &version, &compatible);
  CHECK(compatible == VK_ACCELERATION_STRUCTURE_COMPATIBILITY_COMPATIBLE_KHR);
  Attached attached(client, third);
  const RayStructure bottom = client.build(order_of(client, &attached));
  // A structure has copies of its maps.
  REQUIRE(client.build(bytes_of({any_map(0, k2States, 1)}), third) == VK_SUCCESS);
  require_each(plain, rays.trace(top_of(client, bottom)), by_map);
  CHECK(client.messages.empty());
}

TEST_CASE("the host builds micromaps and structures that have them") {
  MapClient client;
  Rays rays(client);
  const auto plain = rays.trace(top_of(client, client.build(order_of(client, nullptr))));
  const Bytes bytes = bytes_of(pattern());
  const VkMicromapEXT made = client.micromap(client.size_of(bytes));
  VkMicromapBuildInfoEXT info = client.info_of(bytes);
  info.dstMicromap = made, info.data.hostAddress = bytes.data.data();
  info.triangleArray.hostAddress = bytes.triangles.data();
  REQUIRE(client.load<PFN_vkBuildMicromapsEXT>("vkBuildMicromapsEXT")(client.device, nullptr, 1, &info) ==
          VK_SUCCESS);
  Attached attached(client, made);
  attached.info.indexBuffer.hostAddress = kIndices.data();
  BuildOrder order = client.triangles(squares(), true, 0);
  order.geometries[0].geometry.triangles.pNext = &attached.info;

  const RayStructure bottom = client.build_on_host(order);

  require_each(plain, rays.trace(top_of(client, bottom)), by_map);
  CHECK(client.messages.empty());
}

TEST_CASE("without indices the number of a triangle is that of its map, and a base is added") {
  MapClient client;
  Rays rays(client);
  std::vector<Map> maps{any_map(2, k4States, 77)};  // which nobody names
  for (const int16_t index : kIndices)
    maps.push_back(index < 0 ? Map{0, k4States, {uint32_t(-1 - index)}} : pattern()[size_t(index)]);
  const auto plain = rays.trace(top_of(client, client.build(order_of(client, nullptr))));
  Attached attached(client, client.built(maps));
  attached.info.indexType = VK_INDEX_TYPE_NONE_KHR, attached.info.indexBuffer.deviceAddress = 0;
  attached.info.baseTriangle = 1;
  attached.usage.assign(kIndices.size(), {1, 5, k4States});
  attached.info.usageCountsCount = uint32_t(attached.usage.size());
  attached.info.pUsageCounts = attached.usage.data();

  require_each(plain, rays.trace(top_of(client, client.build(order_of(client, &attached)))), by_map);
  CHECK(client.messages.empty());
}

TEST_CASE("micromaps that cannot be are refused by name, and a map that is not there is noted") {
  MapClient client;
  const auto last = [&] { return client.messages.empty() ? std::string() : client.messages.back(); };
  const auto says = [&](const char* text) { return last().find(text) != std::string::npos; };
  const auto result_of = [&](const Bytes& bytes, VkMicromapEXT to) { return client.build(bytes, to); };

  SECTION("too many levels") {
    CHECK(result_of(bytes_of({any_map(7, k4States, 1)}), client.micromap(1 << 16)) ==
          VK_ERROR_VALIDATION_FAILED_EXT);
    CHECK(says("a micromap has subdivision level 7, and there are 0 to 6"));
  }
  SECTION("a format that is none") {
    CHECK(result_of(bytes_of({any_map(1, 3, 1)}), client.micromap(1 << 16)) ==
          VK_ERROR_VALIDATION_FAILED_EXT);
    CHECK(says("a micromap has format 3, and there are 1 (2 states) and 2 (4 states)"));
  }
  SECTION("too little room") {
    CHECK(result_of(bytes_of(pattern()), client.micromap(64)) == VK_ERROR_VALIDATION_FAILED_EXT);
    CHECK(says("a micromap of 3 triangles needs"));
  }
  SECTION("a triangle with more states than the counts say") {
    Bytes bytes = bytes_of(pattern());
    const VkMicromapEXT small = client.micromap(client.size_of(bytes));
    for (auto& each : bytes.triangles) each.subdivisionLevel = 6;
    bytes.data.resize(1 << 14);
    CHECK(result_of(bytes, small) == VK_SUCCESS);
    CHECK(says("bytes do not fit into 'micromap 1'"));
  }
  SECTION("a micromap that is not built") {
    Attached attached(client, client.micromap(1 << 16));
    client.build(order_of(client, &attached));
    CHECK(says("'micromap 1' is not built"));
  }
  SECTION("a map that is not there") {
    Rays rays(client);
    const auto plain = rays.trace(top_of(client, client.build(order_of(client, nullptr))));
    Attached attached(client, client.built(pattern()));
    attached.info.baseTriangle = 1000;
    const RayStructure bottom = client.build(order_of(client, &attached));
    CHECK(client.prints.find("geometry 0: 4 triangles have no micromap") != std::string::npos);
    for (const Found& each : rays.trace(top_of(client, bottom))) REQUIRE(each.asked <= 1);
    CHECK(plain.size() == kRays);
  }
  SECTION("serialised bytes that are none") {
    const MappedBuffer bytes = client.buffer_with_address(256);
    std::memset(bytes.data, 7, 256);
    VkCopyMemoryToMicromapInfoEXT in{VK_STRUCTURE_TYPE_COPY_MEMORY_TO_MICROMAP_INFO_EXT,
                                     nullptr,
                                     {},
                                     client.micromap(1 << 16),
                                     VK_COPY_MICROMAP_MODE_DESERIALIZE_EXT};
    in.src.deviceAddress = client.address(bytes);
    CHECK(client.run([&](VkCommandBuffer commands) {
      client.load<PFN_vkCmdCopyMemoryToMicromapEXT>("vkCmdCopyMemoryToMicromapEXT")(commands, &in);
    }) == VK_SUCCESS);
    CHECK(says("no serialised micromap of this driver lies at"));
  }
}

}  // namespace
}  // namespace glint::test::micromap_test
