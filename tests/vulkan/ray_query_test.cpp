// Tests acceleration structures of applications by ray queries in compute shaders over the Vulkan loader.
// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "tests/support/catch.h"
#include "tests/vulkan/ray_client.h"

namespace glint::test {
namespace {

constexpr uint32_t kNothing = 0xffff'ffff;

// Eight rays go down beside each other. The one at x + 0.4 writes the custom index of what it meets.
const std::string kLookDown = R"(#version 460
#extension GL_EXT_ray_query : require
layout(local_size_x = 8) in;
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1) buffer Found { uint found[]; };
void main() {
  uint i = gl_LocalInvocationIndex;
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene, 0, 0xff, vec3(i + 0.4, 0.3, 5), 0, vec3(0, 0, -1), 100);
  while (rayQueryProceedEXT(query)) {
    if (rayQueryGetIntersectionTypeEXT(query, false) == gl_RayQueryCandidateIntersectionAABBEXT)
      rayQueryGenerateIntersectionEXT(query, 4.0);
    else rayQueryConfirmIntersectionEXT(query);
  }
  bool hit = rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
  found[i] = hit ? rayQueryGetIntersectionInstanceCustomIndexEXT(query, true) : 0xffffffffu;
}
)";

std::vector<uint32_t> look_down(RayClient& client, const RayStructure& top) {
  const MappedBuffer found = client.buffer(64);
  const ComputePipeline pipeline = client.pipeline(
      kLookDown, {{VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}});
  const VkDescriptorSet set = client.ray_set(pipeline.set_layout, top, {found.buffer});
  REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);
  const auto all = found.as<uint32_t>();
  return {all.begin(), all.begin() + 8};
}

// Returns what look_down() finds of squares at 0, 2 and 5 with the custom indices 10, 11 and 12.
const std::vector<uint32_t> kThree{10, kNothing, 11, kNothing, kNothing, 12, kNothing, kNothing};
std::vector<VkAccelerationStructureInstanceKHR> three(uint64_t bottom) {
  return {instance_at(0, 10, bottom), instance_at(2, 11, bottom), instance_at(5, 12, bottom)};
}

TEST_CASE("a ray query meets the instances that an application has built", "[portable][rays]") {
  if (!RayClient::is_possible()) return;
  RayClient client;
  const RayStructure square = client.build(client.triangles(unit_square()));
  const RayStructure top = client.build(client.instances(three(square.address)));

  CHECK(look_down(client, top) == kThree);
  CHECK(client.messages.empty());
}

TEST_CASE("a query decides whether boxes are hit", "[portable][rays]") {
  if (!RayClient::is_possible()) return;
  RayClient client;
  const RayStructure box = client.build(client.boxes({{0, 0, 0, 1, 1, 1}, {3, 0, 0, 4, 1, 1}}));
  const RayStructure top = client.build(client.instances({instance_at(0, 7, box.address)}));

  CHECK(look_down(client, top) ==
        std::vector<uint32_t>{7, kNothing, kNothing, 7, kNothing, kNothing, kNothing, kNothing});
}

TEST_CASE("the host builds the same structures as the device", "[portable][rays]") {
  if (!RayClient::is_possible()) return;
  RayClient client;
  const RayStructure square = client.build_on_host(client.triangles(unit_square(), true));
  const RayStructure top =
      client.build_on_host(client.instances(three(reinterpret_cast<uint64_t>(square.handle)), true));

  CHECK(look_down(client, top) == kThree);
}

TEST_CASE("an indirect build reads its ranges from a buffer", "[portable][rays]") {
  if (!RayClient::is_possible()) return;
  RayClient client;
  const RayStructure square = client.build(client.triangles(unit_square()));
  const BuildOrder order = client.instances(three(square.address));
  const RayStructure top = client.structure(order.type, client.size_of(order));
  const MappedBuffer ranges = client.buffer_with_address(64);
  const VkAccelerationStructureBuildRangeInfoKHR range{2, 0, 0, 0};  // not the third instance
  std::memcpy(ranges.data, &range, sizeof range);
  const MappedBuffer scratch = client.buffer_with_address(1 << 16);
  VkAccelerationStructureBuildGeometryInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR;
  info.type = order.type, info.geometryCount = 1, info.pGeometries = order.geometries.data();
  info.dstAccelerationStructure = top.handle, info.scratchData.deviceAddress = client.address(scratch);

  REQUIRE(client.run([&](VkCommandBuffer commands) {
    const VkDeviceAddress at = client.address(ranges);
    const uint32_t stride = sizeof range, most = 3, *most_of_all = &most;
    client.cmd_build_indirect(commands, 1, &info, &at, &stride, &most_of_all);
  }) == VK_SUCCESS);

  auto expected = kThree;
  expected[5] = kNothing;
  CHECK(look_down(client, top) == expected);
}

TEST_CASE("an update takes the new places of instances", "[portable][rays]") {
  if (!RayClient::is_possible()) return;
  RayClient client;
  const RayStructure square = client.build(client.triangles(unit_square()));
  BuildOrder first = client.instances(three(square.address));
  first.flags = VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR;
  const RayStructure top = client.build(first);
  auto moved = three(square.address);
  moved[0].transform.matrix[0][3] = 7;
  BuildOrder second = client.instances(moved);
  second.flags = first.flags;

  REQUIRE(client.run([&](VkCommandBuffer commands) { client.record_build(commands, second, top, &top); }) ==
          VK_SUCCESS);

  auto expected = kThree;
  expected[0] = kNothing, expected[7] = 10;
  CHECK(look_down(client, top) == expected);
}

TEST_CASE("a compacted structure is smaller and holds the same", "[portable][rays]") {
  if (!RayClient::is_possible()) return;
  RayClient client;
  Corners many;
  for (int i = 0; i < 64; ++i) many.insert(many.end(), unit_square().begin(), unit_square().end());
  BuildOrder order = client.triangles(many);
  order.flags = VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR;
  const RayStructure large = client.build(order);
  const uint32_t bytes = client.property(large, VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR);
  REQUIRE(bytes < large.bytes);
  const RayStructure small = client.structure(order.type, bytes);
  REQUIRE(client.run([&](VkCommandBuffer commands) {
    const VkCopyAccelerationStructureInfoKHR copy{VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR,
                                                  nullptr, large.handle, small.handle,
                                                  VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR};
    client.cmd_copy(commands, &copy);
  }) == VK_SUCCESS);
  std::memset(large.storage.data, 0, large.storage.bytes);

  CHECK(look_down(client, client.build(client.instances(three(small.address)))) == kThree);
}

TEST_CASE("a serialised structure comes back with the bottom levels that its list names", "[rays]") {
  if (!RayClient::is_possible()) return;
  RayClient client;
  const RayStructure square = client.build(client.triangles(unit_square()));
  const RayStructure other = client.build(client.triangles(unit_square()));
  const RayStructure top = client.build(client.instances(three(square.address)));
  const uint32_t bytes = client.property(top, VK_QUERY_TYPE_ACCELERATION_STRUCTURE_SERIALIZATION_SIZE_KHR);
  const MappedBuffer serial = client.buffer_with_address(bytes);
  const VkCopyAccelerationStructureToMemoryInfoKHR out{
      VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_TO_MEMORY_INFO_KHR,
      nullptr,
      top.handle,
      {client.address(serial)},
      VK_COPY_ACCELERATION_STRUCTURE_MODE_SERIALIZE_KHR};
  REQUIRE(client.run([&](VkCommandBuffer commands) { client.cmd_serialize(commands, &out); }) == VK_SUCCESS);
  const auto words = serial.as<uint64_t>();
  REQUIRE(words[6] == 3);  // bottom levels
  for (int i = 0; i < 3; ++i) {
    REQUIRE(words[7 + i] == square.address);
    words[7 + i] = other.address;
  }
  std::memset(square.storage.data, 0, square.storage.bytes);
  const RayStructure back = client.structure(VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, words[5]);
  VkCopyMemoryToAccelerationStructureInfoKHR in{
      VK_STRUCTURE_TYPE_COPY_MEMORY_TO_ACCELERATION_STRUCTURE_INFO_KHR,
      nullptr,
      {client.address(serial)},
      back.handle,
      VK_COPY_ACCELERATION_STRUCTURE_MODE_DESERIALIZE_KHR};
  REQUIRE(client.run([&](VkCommandBuffer commands) { client.cmd_deserialize(commands, &in); }) == VK_SUCCESS);

  CHECK(look_down(client, back) == kThree);
  words[4] = 40;  // bytes of all
  REQUIRE(client.run([&](VkCommandBuffer commands) { client.cmd_deserialize(commands, &in); }) == VK_SUCCESS);
  REQUIRE(client.messages.size() == 1);
  CHECK_THAT(client.messages[0], Catch::Contains("serialised structure"));
}

TEST_CASE("the host serialises structures with handles", "[rays]") {
  if (!RayClient::is_possible()) return;
  RayClient client;
  const RayStructure square = client.build(client.triangles(unit_square()));
  const RayStructure top = client.build(client.instances(three(square.address)));
  std::vector<uint64_t> serial(
      client.property(top, VK_QUERY_TYPE_ACCELERATION_STRUCTURE_SERIALIZATION_SIZE_KHR) / 8 + 1);
  VkCopyAccelerationStructureToMemoryInfoKHR out{};
  out.sType = VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_TO_MEMORY_INFO_KHR, out.src = top.handle;
  out.dst.hostAddress = serial.data(), out.mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_SERIALIZE_KHR;
  REQUIRE(client.host_serialize(client.device, nullptr, &out) == VK_SUCCESS);
  CHECK(serial[7] == reinterpret_cast<uint64_t>(square.handle));
  const RayStructure back = client.structure(VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, serial[5]);
  VkCopyMemoryToAccelerationStructureInfoKHR in{};
  in.sType = VK_STRUCTURE_TYPE_COPY_MEMORY_TO_ACCELERATION_STRUCTURE_INFO_KHR, in.dst = back.handle;
  in.src.hostAddress = serial.data(), in.mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_DESERIALIZE_KHR;
  REQUIRE(client.host_deserialize(client.device, nullptr, &in) == VK_SUCCESS);

  CHECK(look_down(client, back) == kThree);
}

TEST_CASE("hidden instances and wild references are inactive", "[rays]") {
  RayClient client;
  const RayStructure square = client.build(client.triangles(unit_square()));
  auto all = three(square.address);
  all[0].transform = {};                            // no inverse
  all[1].accelerationStructureReference = 0x12345;  // nothing is there
  all.push_back(instance_at(6, 13, 0));

  auto expected = kThree;
  expected[0] = expected[2] = kNothing;
  CHECK(look_down(client, client.build(client.instances(all))) == expected);
  CHECK_THAT(client.prints, Catch::Contains("instance 1: no bottom level"));
}

TEST_CASE("a structure may be made before its buffer has memory", "[rays]") {
  RayClient client;
  const auto buffer_of = [&](VkDeviceSize bytes) {
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes, info.usage = VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR |
                                    VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    VkBuffer out = nullptr;
    REQUIRE(vkCreateBuffer(client.device, &info, nullptr, &out) == VK_SUCCESS);
    return out;
  };
  const auto structure_in = [&](VkBuffer buffer) {
    VkAccelerationStructureCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR;
    info.buffer = buffer, info.offset = 256, info.size = 1024;
    info.type = VK_ACCELERATION_STRUCTURE_TYPE_GENERIC_KHR;
    VkAccelerationStructureKHR out = nullptr;
    REQUIRE(client.create(client.device, &info, nullptr, &out) == VK_SUCCESS);
    return out;
  };
  const VkBuffer never = buffer_of(2048), late = buffer_of(2048);
  const VkAccelerationStructureKHR lost = structure_in(never), made = structure_in(late);
  vkDestroyBuffer(client.device, never, nullptr);
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(client.device, late, &needs);
  VkMemoryAllocateFlagsInfo flags{};
  flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
  flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  VkMemoryAllocateInfo wanted{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, &flags, needs.size, 0};
  VkDeviceMemory memory = nullptr;
  REQUIRE(vkAllocateMemory(client.device, &wanted, nullptr, &memory) == VK_SUCCESS);
  REQUIRE(vkBindBufferMemory(client.device, late, memory, 0) == VK_SUCCESS);
  VkAccelerationStructureDeviceAddressInfoKHR place{
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR, nullptr, made};
  VkBufferDeviceAddressInfo of_buffer{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, nullptr, late};
  CHECK(client.address_of(client.device, &place) ==
        vkGetBufferDeviceAddress(client.device, &of_buffer) + 256);
  for (VkAccelerationStructureKHR each : {lost, made}) client.destroy(client.device, each, nullptr);
  vkDestroyBuffer(client.device, late, nullptr);
  vkFreeMemory(client.device, memory, nullptr);
}

TEST_CASE("a structure without room for what is built is refused when it is recorded", "[rays]") {
  RayClient client;
  const BuildOrder order = client.triangles(unit_square());
  const RayStructure small = client.structure(order.type, 128);
  VkCommandBuffer commands = nullptr;

  CHECK(client.record(commands, [&](VkCommandBuffer into) { client.record_build(into, order, small); }) ==
        VK_ERROR_VALIDATION_FAILED_EXT);
  REQUIRE(client.messages.size() == 1);
  CHECK_THAT(client.messages[0], Catch::Contains("needs up to") && Catch::Contains("has 128"));
}

TEST_CASE("a query in a structure that was never built is a fault, and in none at all too", "[rays]") {
  RayClient client;
  const RayStructure never = client.structure(VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, 4096);

  CHECK(look_down(client, never) == std::vector<uint32_t>(8, kNothing));
  REQUIRE(client.messages.size() == 1);
  CHECK_THAT(client.messages[0], Catch::Contains("not a top-level acceleration structure"));
  CHECK(look_down(client, {}) == std::vector<uint32_t>(8, kNothing));
  CHECK(client.messages.size() == 2);
}

}  // namespace
}  // namespace glint::test
