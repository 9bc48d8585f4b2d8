// Tests kinds of descriptors and ways to write them: texel buffers, inline uniform blocks, update templates,
// pushed sets, many dynamic offsets, and memory that the application brings.
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "tests/support/catch.h"
#include "tests/vulkan/client.h"

namespace glint::test::descriptor_test {
namespace {

constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkDescriptorType kInline = VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK;
constexpr uint32_t kThreads = 64;
const std::string kHead = "#version 460\nlayout(local_size_x = 64) in;\n";
const std::string kOut = kHead + "layout(set = 0, binding = 0) buffer A { uint a[]; };\n";
const std::string kIndex = "uint i = gl_LocalInvocationIndex; ";

VkBufferView view_of(Client& client, const MappedBuffer& buffer, VkFormat format, VkDeviceSize offset = 0) {
  VkBufferViewCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO, info.buffer = buffer.buffer, info.format = format;
  info.offset = offset, info.range = VK_WHOLE_SIZE;
  VkBufferView out = nullptr;
  check(vkCreateBufferView(client.device, &info, nullptr, &out), "vkCreateBufferView");
  client.at_end([device = client.device, out] { vkDestroyBufferView(device, out, nullptr); });
  return out;
}

// Allocates a set whose pool has `size` of each of the types.
VkDescriptorSet allocate(Client& client, VkDescriptorSetLayout layout,
                         const std::vector<VkDescriptorPoolSize>& sizes, const void* more = nullptr,
                         const void* more_of_set = nullptr) {
  VkDescriptorPoolCreateInfo info{
      VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, more, 0, 1, uint32_t(sizes.size()), sizes.data()};
  VkDescriptorPool pool = nullptr;
  check(vkCreateDescriptorPool(client.device, &info, nullptr, &pool), "vkCreateDescriptorPool");
  client.at_end([device = client.device, pool] { vkDestroyDescriptorPool(device, pool, nullptr); });
  VkDescriptorSetAllocateInfo wanted{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, more_of_set, pool, 1,
                                     &layout};
  VkDescriptorSet out = nullptr;
  check(vkAllocateDescriptorSets(client.device, &wanted, &out), "vkAllocateDescriptorSets");
  return out;
}

VkWriteDescriptorSet write_of(VkDescriptorSet set, uint32_t binding, VkDescriptorType type) {
  VkWriteDescriptorSet out{};
  out.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, out.dstSet = set, out.dstBinding = binding;
  out.descriptorCount = 1, out.descriptorType = type;
  return out;
}

TEST_CASE("texel buffers are read and written in their formats, from their offsets on", "[portable]") {
  Client client;
  const MappedBuffer bytes = client.buffer(1024, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  const MappedBuffer words = client.buffer(1024, VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT);
  for (uint32_t i = 0; i < 1024; ++i) bytes.as<uint8_t>()[i] = uint8_t(i);
  std::memset(words.data, 0, words.bytes);
  const std::array types{VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER};
  const ComputePipeline pipeline =
      client.pipeline(kHead +
                          "layout(set = 0, binding = 0) uniform textureBuffer from;\n"
                          "layout(set = 0, binding = 1, r32ui) uniform uimageBuffer to;\n"
                          "void main() { " +
                          kIndex +
                          "vec4 t = texelFetch(from, int(i)) * 255.0;\n"
                          "  imageStore(to, int(i), uvec4(uint(t.x + 0.5) + 1000u * uint(t.w + 0.5))); }\n",
                      {{types[0], types[1]}});
  const VkDescriptorSet set = allocate(client, pipeline.set_layout, {{types[0], 1}, {types[1], 1}});
  const std::array views{view_of(client, bytes, VK_FORMAT_R8G8B8A8_UNORM, 256),
                         view_of(client, words, VK_FORMAT_R32_UINT, 512)};
  for (uint32_t i = 0; i < 2; ++i) {
    VkWriteDescriptorSet write = write_of(set, i, types[i]);
    write.pTexelBufferView = &views[i];
    vkUpdateDescriptorSets(client.device, 1, &write, 0, nullptr);
  }

  REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);

  for (uint32_t i = 0; i < kThreads; ++i) {
    CHECK(words.as<uint32_t>()[i] == 0);
    CHECK(words.as<uint32_t>()[128 + i] == 4 * i + 1000 * (4 * i + 3));
  }
}

TEST_CASE("a descriptor that no shader uses may name a view that is destroyed") {
  Client client;
  const MappedBuffer out = client.buffer(256);
  const MappedBuffer bytes = client.buffer(256, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  std::memset(out.data, 0, out.bytes);
  const std::array types{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER};
  const ComputePipeline pipeline =
      client.pipeline(kHead +
                          "layout(set = 0, binding = 0) buffer Out { uint v[]; };\n"
                          "layout(set = 0, binding = 1) uniform textureBuffer gone;\n"
                          "void main() { if (v[0] == 7) v[1] = uint(texelFetch(gone, 0).x); v[2] = 5; }\n",
                      {{types[0], types[1]}});
  const VkDescriptorSet set = allocate(client, pipeline.set_layout, {{types[0], 1}, {types[1], 1}});
  VkBufferViewCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO;
  info.buffer = bytes.buffer, info.format = VK_FORMAT_R8G8B8A8_UNORM, info.range = VK_WHOLE_SIZE;
  VkBufferView view = nullptr;
  REQUIRE(vkCreateBufferView(client.device, &info, nullptr, &view) == VK_SUCCESS);
  const VkDescriptorBufferInfo whole{out.buffer, 0, VK_WHOLE_SIZE};
  VkWriteDescriptorSet writes[] = {write_of(set, 0, types[0]), write_of(set, 1, types[1])};
  writes[0].pBufferInfo = &whole, writes[1].pTexelBufferView = &view;
  vkUpdateDescriptorSets(client.device, 2, writes, 0, nullptr);
  vkDestroyBufferView(client.device, view, nullptr);
  // Something else lies where the view was.
  std::vector<std::vector<std::byte>> others;
  for (size_t size = 16; size <= 512; size += 8) others.emplace_back(size, std::byte{0xff});

  REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);

  CHECK(out.as<uint32_t>()[1] == 0);
  CHECK(out.as<uint32_t>()[2] == 5);
  CHECK(client.messages.empty());
}

TEST_CASE("bindings may have any numbers, and arrays and plain ones keep apart", "[portable]") {
  Client client;
  const MappedBuffer out = client.buffer(256), in = client.buffer(256);
  for (uint32_t i = 0; i < kThreads; ++i) in.as<uint32_t>()[i] = i * i;
  const std::vector<uint32_t> numbers{0, 1023, 1024, 32766};
  const ComputePipeline pipeline =
      client.pipeline(kHead +
                          "layout(set = 0, binding = 32766) buffer A { uint a[]; };\n"
                          "layout(set = 0, binding = 0) buffer B { uint b[]; };\n"
                          "layout(set = 0, binding = 1023) buffer C { uint c[]; };\n"
                          "layout(set = 0, binding = 1024) buffer D { uint d[]; };\n"
                          "void main() { " +
                          kIndex + "a[i] = b[i] + c[63u - i] + 2u * d[i]; }\n",
                      {.bindings = {kStorage, kStorage, kStorage, kStorage}, .numbers = numbers});
  const VkDescriptorSet set = allocate(client, pipeline.set_layout, {{kStorage, 4}});
  for (const uint32_t number : numbers) {
    const VkDescriptorBufferInfo all{number == 32766 ? out.buffer : in.buffer, 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write = write_of(set, number, kStorage);
    write.pBufferInfo = &all;
    vkUpdateDescriptorSets(client.device, 1, &write, 0, nullptr);
  }

  REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);

  for (uint32_t i = 0; i < kThreads; ++i) REQUIRE(out.as<uint32_t>()[i] == 3 * i * i + (63 - i) * (63 - i));
}

TEST_CASE("an update template writes buffers from the application's own structure", "[portable]") {
  Client client;
  const MappedBuffer out = client.buffer(256), in = client.buffer(256);
  for (uint32_t i = 0; i < kThreads; ++i) in.as<uint32_t>()[i] = i * i;
  const ComputePipeline pipeline =
      client.pipeline(kOut +
                          "layout(set = 0, binding = 1) buffer B { uint b[]; };\n"
                          "void main() { " +
                          kIndex + "a[i] = b[i] + 5u; }\n",
                      {{kStorage, kStorage}});
  const VkDescriptorSet set = allocate(client, pipeline.set_layout, {{kStorage, 2}});
  struct Data {
    uint64_t something = 1;
    VkDescriptorBufferInfo out, in;
  } data;
  data.out = {out.buffer, 0, VK_WHOLE_SIZE}, data.in = {in.buffer, 0, VK_WHOLE_SIZE};
  const std::array<VkDescriptorUpdateTemplateEntry, 2> entries{
      {{0, 0, 1, kStorage, offsetof(Data, out), 0}, {1, 0, 1, kStorage, offsetof(Data, in), 0}}};
  VkDescriptorUpdateTemplateCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_UPDATE_TEMPLATE_CREATE_INFO;
  info.descriptorUpdateEntryCount = 2, info.pDescriptorUpdateEntries = entries.data();
  info.templateType = VK_DESCRIPTOR_UPDATE_TEMPLATE_TYPE_DESCRIPTOR_SET;
  info.descriptorSetLayout = pipeline.set_layout;
  VkDescriptorUpdateTemplate made = nullptr;
  REQUIRE(vkCreateDescriptorUpdateTemplate(client.device, &info, nullptr, &made) == VK_SUCCESS);

  vkUpdateDescriptorSetWithTemplate(client.device, set, made, &data);
  vkDestroyDescriptorUpdateTemplate(client.device, made, nullptr);
  REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);

  for (uint32_t i = 0; i < kThreads; ++i) REQUIRE(out.as<uint32_t>()[i] == i * i + 5);
}

TEST_CASE("an inline uniform block holds the bytes that were written into its set", "[portable]") {
  const VkPhysicalDeviceInlineUniformBlockFeatures features{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_INLINE_UNIFORM_BLOCK_FEATURES, nullptr, VK_TRUE, VK_FALSE};
  Client::Options options;
  options.more_features = &features;
  Client client(options);
  const MappedBuffer out = client.buffer(256);
  PipelineOptions of{{kStorage, kInline}};
  of.inline_bytes = 32;
  const ComputePipeline pipeline =
      client.pipeline(kOut +
                          "layout(set = 0, binding = 1) uniform U { uvec4 x, y; };\n"
                          "void main() { " +
                          kIndex + "a[i] = i * x.x + y.w; }\n",
                      of);
  const VkDescriptorPoolInlineUniformBlockCreateInfo blocks{
      VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_INLINE_UNIFORM_BLOCK_CREATE_INFO, nullptr, 1};
  const VkDescriptorSet set = allocate(client, pipeline.set_layout, {{kStorage, 1}, {kInline, 32}}, &blocks);
  const VkDescriptorBufferInfo buffer{out.buffer, 0, VK_WHOLE_SIZE};
  const std::array<uint32_t, 8> values{3, 0, 0, 0, 0, 0, 0, 9};
  const VkWriteDescriptorSetInlineUniformBlock block{
      VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_INLINE_UNIFORM_BLOCK, nullptr, sizeof values, values.data()};
  std::array writes{write_of(set, 0, kStorage), write_of(set, 1, kInline)};
  writes[0].pBufferInfo = &buffer;
  writes[1].pNext = &block, writes[1].descriptorCount = sizeof values;
  vkUpdateDescriptorSets(client.device, 2, writes.data(), 0, nullptr);

  REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);

  for (uint32_t i = 0; i < kThreads; ++i) REQUIRE(out.as<uint32_t>()[i] == i * 3 + 9);
}

TEST_CASE("a set may have an inline uniform block of its own length") {
  VkPhysicalDeviceInlineUniformBlockFeatures blocks{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_INLINE_UNIFORM_BLOCK_FEATURES, nullptr, VK_TRUE, VK_FALSE};
  VkPhysicalDeviceDescriptorIndexingFeatures lengths{};
  lengths.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DESCRIPTOR_INDEXING_FEATURES, lengths.pNext = &blocks;
  lengths.descriptorBindingVariableDescriptorCount = VK_TRUE;
  Client::Options options;
  options.more_features = &lengths;
  Client client(options);
  const VkDescriptorBindingFlags flag = VK_DESCRIPTOR_BINDING_VARIABLE_DESCRIPTOR_COUNT_BIT;
  const VkDescriptorSetLayoutBindingFlagsCreateInfo flags{
      VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO, nullptr, 1, &flag};
  const VkDescriptorSetLayoutBinding binding{0, kInline, 64, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
  const VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, &flags, 0,
                                             1, &binding};
  VkDescriptorSetLayout layout = nullptr;
  REQUIRE(vkCreateDescriptorSetLayout(client.device, &info, nullptr, &layout) == VK_SUCCESS);
  const uint32_t bytes = 32;
  const VkDescriptorSetVariableDescriptorCountAllocateInfo own{
      VK_STRUCTURE_TYPE_DESCRIPTOR_SET_VARIABLE_DESCRIPTOR_COUNT_ALLOCATE_INFO, nullptr, 1, &bytes};
  const VkDescriptorPoolInlineUniformBlockCreateInfo one{
      VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_INLINE_UNIFORM_BLOCK_CREATE_INFO, nullptr, 1};
  CHECK(allocate(client, layout, {{kInline, 64}}, &one, &own) != nullptr);
  vkDestroyDescriptorSetLayout(client.device, layout, nullptr);
}

TEST_CASE("memory that the application brings is read and written in place", "[portable]") {
  Client::Options options;
  options.extensions = {VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME};
  Client client(options);
  constexpr size_t kBytes = 65536;  // a multiple of every device's alignment
  const std::unique_ptr<void, decltype(&std::free)> bytes(std::aligned_alloc(kBytes, kBytes), &std::free);
  auto* const words = static_cast<uint32_t*>(bytes.get());
  for (uint32_t i = 0; i < kThreads; ++i) words[i] = 100 + i;
  const VkBuffer imported = client.import(bytes.get(), kBytes);
  const ComputePipeline pipeline =
      client.pipeline(kOut + "void main() { " + kIndex + "a[i] = a[i] * 2u; }\n", {{kStorage}});
  const VkDescriptorSet set = client.set(pipeline.set_layout, {{imported, 0, VK_WHOLE_SIZE}});

  REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);

  for (uint32_t i = 0; i < kThreads; ++i) REQUIRE(words[i] == 200 + 2 * i);
}

TEST_CASE("a set is pushed with another layout after a first one", "[portable]") {
  Client::Options options;
  options.extensions = {VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
  Client client(options);
  const MappedBuffer out = client.buffer(256), in = client.buffer(256);
  for (uint32_t i = 0; i < kThreads; ++i) in.as<uint32_t>()[i] = 7 * i;
  const VkDescriptorSetLayoutCreateFlags pushed = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
  const ComputePipeline first = client.pipeline(kOut + "void main() { a[gl_LocalInvocationIndex] = 1; }\n",
                                                {{kStorage}, 0, nullptr, pushed});
  const ComputePipeline second = client.pipeline(kOut +
                                                     "layout(set = 0, binding = 1) buffer B { uint b[]; };\n"
                                                     "void main() { " +
                                                     kIndex + "a[i] += b[i]; }\n",
                                                 {{kStorage, kStorage}, 0, nullptr, pushed});
  const auto push = client.load<PFN_vkCmdPushDescriptorSetKHR>("vkCmdPushDescriptorSetKHR");
  const std::array<VkDescriptorBufferInfo, 2> buffers{
      {{out.buffer, 0, VK_WHOLE_SIZE}, {in.buffer, 0, VK_WHOLE_SIZE}}};
  std::array writes{write_of(nullptr, 0, kStorage), write_of(nullptr, 1, kStorage)};
  for (uint32_t i = 0; i < 2; ++i) writes[i].pBufferInfo = &buffers[i];

  REQUIRE(client.run([&](VkCommandBuffer commands) {
    const VkMemoryBarrier all{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_SHADER_WRITE_BIT,
                              VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT};
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, first.pipeline);
    push(commands, VK_PIPELINE_BIND_POINT_COMPUTE, first.layout, 0, 1, writes.data());
    vkCmdDispatch(commands, 1, 1, 1);
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                         0, 1, &all, 0, nullptr, 0, nullptr);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, second.pipeline);
    push(commands, VK_PIPELINE_BIND_POINT_COMPUTE, second.layout, 0, 2, writes.data());
    vkCmdDispatch(commands, 1, 1, 1);
  }) == VK_SUCCESS);

  for (uint32_t i = 0; i < kThreads; ++i) REQUIRE(out.as<uint32_t>()[i] == 1 + 7 * i);
}

// The driver shows a part of a buffer through a window on it, and the address space has 65,536 places.
TEST_CASE("more dynamic offsets than the address space has places") {
  Client client;
  constexpr uint32_t kAtOnce = 64, kLaunches = 1030, kStep = 16;
  const MappedBuffer out = client.buffer(VkDeviceSize{kAtOnce} * kLaunches * kStep + kStep);
  std::memset(out.data, 0, out.bytes);
  const VkDescriptorType dynamic = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC;
  std::string declared = "#version 460\n", body;
  for (uint32_t i = 0; i < kAtOnce; ++i) {
    const std::string n = std::to_string(i);
    declared += "layout(set = 0, binding = " + n + ") buffer A" + n + " { uint a" + n + "[]; };\n";
    body += "a" + n + "[0] += 1; ";
  }
  const ComputePipeline pipeline =
      client.pipeline(declared + "void main() { " + body + "}\n", {std::vector(kAtOnce, dynamic)});
  const VkDescriptorSet set = client.set(
      pipeline.set_layout, std::vector(kAtOnce, VkDescriptorBufferInfo{out.buffer, 0, kStep}), dynamic);

  REQUIRE(client.run([&](VkCommandBuffer commands) {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
    for (uint32_t launch = 0; launch < kLaunches; ++launch) {
      std::array<uint32_t, kAtOnce> offsets;
      for (uint32_t i = 0; i < kAtOnce; ++i) offsets[i] = (launch * kAtOnce + i) * kStep;
      vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &set, kAtOnce,
                              offsets.data());
      vkCmdDispatch(commands, 1, 1, 1);
    }
  }) == VK_SUCCESS);

  uint32_t wrong = 0;
  for (uint32_t i = 0; i < kAtOnce * kLaunches; ++i) wrong += out.as<uint32_t>()[4 * size_t{i}] != 1;
  CHECK(wrong == 0);
}

}  // namespace
}  // namespace glint::test::descriptor_test
