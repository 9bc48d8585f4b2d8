// Tests that compute programs over the Vulkan loader compute what the same loops compute in C++.
// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <numeric>

#include "tests/support/catch.h"
#include "tests/vulkan/client.h"

// Tests with the tag [portable] hold on every Vulkan device, and run on lavapipe too where it is installed.
namespace glint::test::compute_test {
namespace {

constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
const std::string kHead =
    "#version 460\nlayout(local_size_x = 64) in;\n"
    "layout(set = 0, binding = 0) buffer A { uint a[]; };\n";
const std::string kCopy = kHead +
                          "layout(set = 0, binding = 1) buffer B { uint b[]; };\n"
                          "void main() { uint i = gl_GlobalInvocationID.x; b[i] = a[i] * 3u + i; }\n";

TEST_CASE("a kernel over two buffers computes what C++ computes", "[portable]") {
  Client client;
  const MappedBuffer in = client.buffer(1024 * 4), out = client.buffer(1024 * 4);
  std::iota(in.as<uint32_t>().begin(), in.as<uint32_t>().end(), 7u);
  const ComputePipeline pipeline = client.pipeline(kCopy, {{kStorage, kStorage}});
  const VkDescriptorSet set =
      client.set(pipeline.set_layout, {{in.buffer, 0, VK_WHOLE_SIZE}, {out.buffer, 0, VK_WHOLE_SIZE}});

  REQUIRE(client.dispatch(pipeline, set, {16, 1, 1}) == VK_SUCCESS);

  for (uint32_t i = 0; i < 1024; ++i) REQUIRE(out.as<uint32_t>()[i] == (i + 7) * 3 + i);
  CHECK(client.messages.empty());
}

TEST_CASE("push constants and specialisation constants reach the shader", "[portable]") {
  Client client;
  const MappedBuffer out = client.buffer(256);
  const uint32_t constant = 1000;
  const VkSpecializationMapEntry entry{5, 0, 4};
  const VkSpecializationInfo constants{1, &entry, 4, &constant};
  const ComputePipeline pipeline = client.pipeline(
      kHead +
          "layout(constant_id = 5) const uint scale = 1; layout(push_constant) uniform P { uint x, y; };\n"
          "void main() { uint i = gl_GlobalInvocationID.x; a[i] = i * scale + x - y; }\n",
      {{kStorage}, 8, &constants});
  const VkDescriptorSet set = client.set(pipeline.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});

  REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}, {50, 8}) == VK_SUCCESS);

  for (uint32_t i = 0; i < 64; ++i) REQUIRE(out.as<uint32_t>()[i] == i * 1000 + 42);
}

TEST_CASE("an indirect dispatch reads its size from a buffer that the queue has just filled", "[portable]") {
  Client client;
  const MappedBuffer out = client.buffer(1024), size = client.buffer(64), source = client.buffer(64);
  const std::array<uint32_t, 3> groups{3, 1, 1};
  std::memcpy(source.data, groups.data(), sizeof groups);
  const ComputePipeline pipeline =
      client.pipeline(kHead + "void main() { a[gl_GlobalInvocationID.x] = 1; }\n", {{kStorage}});
  const VkDescriptorSet set = client.set(pipeline.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});

  REQUIRE(client.run([&](VkCommandBuffer commands) {
    const VkBufferCopy region{0, 16, sizeof groups};
    vkCmdFillBuffer(commands, out.buffer, 0, VK_WHOLE_SIZE, 9);
    vkCmdCopyBuffer(commands, source.buffer, size.buffer, 1, &region);
    const VkMemoryBarrier all{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_MEMORY_WRITE_BIT,
                              VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0,
                         1, &all, 0, nullptr, 0, nullptr);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &set, 0,
                            nullptr);
    vkCmdDispatchIndirect(commands, size.buffer, 16);
  }) == VK_SUCCESS);

  for (uint32_t i = 0; i < 256; ++i) REQUIRE(out.as<uint32_t>()[i] == (i < 192 ? 1 : 9));
}

TEST_CASE("a dispatch with a base numbers its groups from there", "[portable]") {
  Client client;
  const MappedBuffer out = client.buffer(1024);
  std::memset(out.data, 0, out.bytes);
  const ComputePipeline pipeline = client.pipeline(
      kHead + "void main() { a[gl_GlobalInvocationID.x] = gl_WorkGroupID.x; }\n", {{kStorage}});
  const VkDescriptorSet set = client.set(pipeline.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});

  REQUIRE(client.run([&](VkCommandBuffer commands) {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &set, 0,
                            nullptr);
    vkCmdDispatchBase(commands, 2, 0, 0, 2, 1, 1);
  }) == VK_SUCCESS);

  for (uint32_t i = 0; i < 256; ++i) REQUIRE(out.as<uint32_t>()[i] == (i < 128 ? 0 : i / 64));
}

TEST_CASE("dynamic offsets move the part of a buffer that a descriptor shows", "[portable]") {
  Client client;
  const MappedBuffer out = client.buffer(4096);
  std::memset(out.data, 0, out.bytes);
  const VkDescriptorType dynamic = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC;
  const ComputePipeline pipeline =
      client.pipeline(kHead + "void main() { a[gl_LocalInvocationIndex] += 1; }\n", {{dynamic}});
  const VkDescriptorSet set = client.set(pipeline.set_layout, {{out.buffer, 256, 256}}, dynamic);

  REQUIRE(client.run([&](VkCommandBuffer commands) {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
    for (const uint32_t offset : {0u, 1024u}) {
      vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &set, 1,
                              &offset);
      vkCmdDispatch(commands, 1, 1, 1);
    }
  }) == VK_SUCCESS);

  for (uint32_t i = 0; i < 1024; ++i)
    REQUIRE(out.as<uint32_t>()[i] == ((i >= 64 && i < 128) || (i >= 320 && i < 384)));
}

TEST_CASE("a pointer from vkGetBufferDeviceAddress is where the buffer is", "[portable]") {
  VkPhysicalDeviceVulkan12Features features{};
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  features.bufferDeviceAddress = VK_TRUE;
  Client::Options options;
  options.more_features = &features;
  options.features.shaderInt64 = VK_TRUE;
  Client client(options);
  const MappedBuffer out = client.buffer(256, Client::kAllUses | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT);
  const VkBufferDeviceAddressInfo wanted{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, nullptr, out.buffer};
  const uint64_t address = vkGetBufferDeviceAddress(client.device, &wanted);
  const ComputePipeline pipeline = client.pipeline(
      "#version 460\n#extension GL_EXT_buffer_reference : require\nlayout(local_size_x = 64) in;\n"
      "layout(buffer_reference) buffer R { uint v[]; };\nlayout(push_constant) uniform P { R r; };\n"
      "void main() { uint i = gl_LocalInvocationIndex; r.v[i] = i ^ 21u; }\n",
      {{}, 8});

  REQUIRE(client.dispatch(pipeline, nullptr, {1, 1, 1}, {uint32_t(address), uint32_t(address >> 32)}) ==
          VK_SUCCESS);

  for (uint32_t i = 0; i < 64; ++i) REQUIRE(out.as<uint32_t>()[i] == (i ^ 21));
}

TEST_CASE("pushed descriptors are those of the launch that follows them", "[portable]") {
  Client::Options options;
  options.extensions = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
  Client client(options);
  const std::array<MappedBuffer, 2> out{client.buffer(256), client.buffer(256)};
  const ComputePipeline pipeline =
      client.pipeline(kHead +
                          "layout(push_constant) uniform P { uint x; };\n"
                          "void main() { a[gl_LocalInvocationIndex] = x; }\n",
                      {{kStorage}, 4, nullptr, VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR});
  const auto push = client.load<PFN_vkCmdPushDescriptorSetKHR>("vkCmdPushDescriptorSetKHR");

  REQUIRE(client.run([&](VkCommandBuffer commands) {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
    for (uint32_t i = 0; i < 2; ++i) {
      const VkDescriptorBufferInfo buffer{out[i].buffer, 0, VK_WHOLE_SIZE};
      VkWriteDescriptorSet write{};
      write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, write.descriptorCount = 1;
      write.descriptorType = kStorage, write.pBufferInfo = &buffer;
      push(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &write);
      const uint32_t value = 40 + i;
      vkCmdPushConstants(commands, pipeline.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, 4, &value);
      vkCmdDispatch(commands, 1, 1, 1);
    }
  }) == VK_SUCCESS);

  for (uint32_t i = 0; i < 64; ++i) {
    REQUIRE(out[0].as<uint32_t>()[i] == 40);
    REQUIRE(out[1].as<uint32_t>()[i] == 41);
  }
}

TEST_CASE("atomics change floats of 16, 32 and 64 bits in buffers and in shared memory") {
  VkPhysicalDeviceShaderAtomicFloat2FeaturesEXT more{};
  more.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_2_FEATURES_EXT;
  more.shaderBufferFloat16AtomicAdd = more.shaderBufferFloat32AtomicMinMax = VK_TRUE;
  more.shaderSharedFloat64AtomicMinMax = VK_TRUE;
  VkPhysicalDeviceShaderAtomicFloatFeaturesEXT first{};
  first.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_FEATURES_EXT, first.pNext = &more;
  first.shaderBufferFloat32AtomicAdd = first.shaderBufferFloat64AtomicAdd = VK_TRUE;
  first.shaderSharedFloat32AtomicAdd = VK_TRUE;
  Client::Options options;
  options.extensions = {"VK_EXT_shader_atomic_float", "VK_EXT_shader_atomic_float2"};
  options.features.shaderFloat64 = VK_TRUE, options.more_features = &first;
  Client client(options);
  const MappedBuffer out = client.buffer(48);
  const ComputePipeline pipeline = client.pipeline(
      "#version 460\n#extension GL_EXT_shader_atomic_float : require\n"
      "#extension GL_EXT_shader_atomic_float2 : require\n"
      "#extension GL_EXT_shader_explicit_arithmetic_types : require\nlayout(local_size_x = 64) in;\n"
      "layout(set = 0, binding = 0) buffer O { double d, e; float f, g, h; float16_t half_; };\n"
      "shared float s; shared double m;\nvoid main() { uint i = gl_LocalInvocationIndex;\n"
      "  if (i == 0) { s = 0; m = 0; }\n  barrier();\n"
      "  atomicAdd(d, 0.25lf); atomicAdd(f, 0.5); atomicMin(g, -float(i)); atomicAdd(half_, float16_t(1));\n"
      "  atomicAdd(s, 2.0); atomicMax(m, double(i));\n  barrier();\n  if (i == 0) { h = s; e = m; } }\n",
      {{kStorage}});
  const VkDescriptorSet set = client.set(pipeline.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});

  REQUIRE(client.dispatch(pipeline, set, {2, 1, 1}) == VK_SUCCESS);

  CHECK(out.as<double>()[0] == 32);
  CHECK(out.as<double>()[1] == 63);
  CHECK(out.as<float>()[4] == 64);
  CHECK(out.as<float>()[5] == -63);
  CHECK(out.as<float>()[6] == 128);
  CHECK(out.as<uint16_t>()[14] == 0x5800);  // 128 as a half
}

TEST_CASE("derivatives of compute shaders are those of the quads of a derivative group") {
  VkPhysicalDeviceComputeShaderDerivativesFeaturesNV derivatives{};
  derivatives.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_COMPUTE_SHADER_DERIVATIVES_FEATURES_NV;
  derivatives.computeDerivativeGroupQuads = VK_TRUE;
  Client::Options options;
  options.extensions = {"VK_NV_compute_shader_derivatives"}, options.more_features = &derivatives;
  Client client(options);
  const MappedBuffer out = client.buffer(64 * 8);
  const ComputePipeline pipeline = client.pipeline(
      "#version 460\n#extension GL_NV_compute_shader_derivatives : require\n"
      "layout(local_size_x = 8, local_size_y = 8, derivative_group_quadsNV) in;\n"
      "layout(set = 0, binding = 0) buffer O { vec2 o[]; };\nvoid main() { uvec2 p = "
      "gl_LocalInvocationID.xy;\n"
      "  float f = float(p.x * 3 + p.y * p.y);\n  o[p.y * 8 + p.x] = vec2(dFdx(f), dFdy(f)); }\n",
      {{kStorage}});
  const VkDescriptorSet set = client.set(pipeline.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});

  REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);

  for (uint32_t i = 0; i < 64; ++i) {
    const uint32_t top = i / 8 & ~1u;
    CHECK(out.as<float>()[2 * i] == 3);
    CHECK(out.as<float>()[2 * i + 1] == float(2 * top + 1));
  }
}

}  // namespace
}  // namespace glint::test::compute_test
