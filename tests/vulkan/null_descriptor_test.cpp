// Tests descriptors of nothing, and accesses past the ranges of descriptors (VK_EXT_robustness2).
// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

#include "tests/support/catch.h"
#include "tests/vulkan/ray_client.h"

namespace glint::test::null_descriptor_test {
namespace {

constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkDescriptorType kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
constexpr VkDescriptorType kSampled = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
constexpr VkDescriptorType kStructure = VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR;
constexpr uint32_t kUntouched = 0xdead;

// Holds the features that a client asks for. The client's device is made from its address.
struct Wanted {
  explicit Wanted(bool null_descriptors) {
    robust.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ROBUSTNESS_2_FEATURES_EXT, robust.pNext = &stored;
    robust.nullDescriptor = null_descriptors;
    stored.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DESCRIPTOR_BUFFER_FEATURES_EXT;
    stored.descriptorBuffer = VK_TRUE;
  }
  VkPhysicalDeviceRobustness2FeaturesEXT robust{};
  VkPhysicalDeviceDescriptorBufferFeaturesEXT stored{};
};

class NullClient : private Wanted, public RayClient {
 public:
  explicit NullClient(bool null_descriptors = true)
      : Wanted(null_descriptors),
        RayClient({VK_EXT_ROBUSTNESS_2_EXTENSION_NAME, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME,
                   VK_EXT_DESCRIPTOR_BUFFER_EXTENSION_NAME},
                  &this->robust) {}
};

// Binding 0 takes the answers, and every other binding is null. Each answer is 0 but the last.
const std::vector<VkDescriptorType> kTypes{kStorage,
                                           kStorage,
                                           kUniform,
                                           VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
                                           VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER,
                                           kSampled,
                                           VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                                           kStructure};
constexpr uint32_t kAnswers = 21;
const std::string kShader = R"(#version 460
#extension GL_EXT_ray_query : enable
#extension GL_EXT_samplerless_texture_functions : enable
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) buffer Out { uint v[]; };
layout(set = 0, binding = 1) buffer Nothing { uint head; vec4 rest[]; } nothing;
layout(set = 0, binding = 2) uniform Values { uvec4 x[4]; } values;
layout(set = 0, binding = 3) uniform utextureBuffer texels;
layout(set = 0, binding = 4, r32ui) uniform uimageBuffer stored;
layout(set = 0, binding = 5) uniform sampler2D picture;
layout(set = 0, binding = 6, rgba8) uniform image2D canvas;
layout(set = 0, binding = 7) uniform accelerationStructureEXT scene;
void main() {
  uint i = 0;
  nothing.head = 7u, nothing.rest[1000] = vec4(1);
  v[i++] = nothing.head;
  v[i++] = floatBitsToUint(nothing.rest[1000].w);
  v[i++] = nothing.rest.length();
  v[i++] = atomicAdd(nothing.head, 5u);
  v[i++] = values.x[3].y;
  v[i++] = texelFetch(texels, 3).x;
  v[i++] = textureSize(texels);
  imageStore(stored, 5, uvec4(9));
  v[i++] = imageLoad(stored, 5).x;
  v[i++] = imageAtomicMax(stored, 5, 3u);
  v[i++] = imageSize(stored);
  v[i++] = floatBitsToUint(textureLod(picture, vec2(0.5), 0).w);
  v[i++] = floatBitsToUint(texelFetch(picture, ivec2(0), 0).w);
  v[i++] = floatBitsToUint(textureGather(picture, vec2(0.5)).x);
  v[i++] = textureSize(picture, 0).x;
  v[i++] = textureSize(picture, 0).y;
  v[i++] = textureQueryLevels(picture);
  imageStore(canvas, ivec2(1), vec4(1));
  v[i++] = floatBitsToUint(imageLoad(canvas, ivec2(1)).w);
  v[i++] = imageSize(canvas).x;
  v[i++] = imageSize(canvas).y;
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene, 0, 0xff, vec3(0), 0, vec3(0, 0, 1), 100);
  uint met = 0;
  while (rayQueryProceedEXT(query)) ++met;
  v[i++] = met + rayQueryGetIntersectionTypeEXT(query, true);
  v[i++] = 77u;
}
)";

// Holds null handles for writes of any type, and one buffer for binding 0.
struct Writes {
  Writes(VkBuffer out, VkSampler sampler, VkDescriptorSet set) {
    answers = {out, 0, VK_WHOLE_SIZE}, image.sampler = sampler;
    structures.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR;
    structures.accelerationStructureCount = 1, structures.pAccelerationStructures = &structure;
    for (uint32_t i = 0; i < kTypes.size(); ++i) {
      VkWriteDescriptorSet& write = all.emplace_back();
      write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, write.dstSet = set, write.dstBinding = i;
      write.descriptorCount = 1, write.descriptorType = kTypes[i];
      write.pBufferInfo = i ? &buffer : &answers, write.pImageInfo = &image, write.pTexelBufferView = &texels;
      if (kTypes[i] == kStructure) write.pNext = &structures;
    }
  }
  VkDescriptorBufferInfo answers{}, buffer{nullptr, 0, VK_WHOLE_SIZE};
  VkDescriptorImageInfo image{nullptr, nullptr, VK_IMAGE_LAYOUT_GENERAL};
  VkBufferView texels = nullptr;
  VkAccelerationStructureKHR structure = nullptr;
  VkWriteDescriptorSetAccelerationStructureKHR structures{};
  std::vector<VkWriteDescriptorSet> all;
};

VkDescriptorSet allocate(Client& client, VkDescriptorSetLayout layout,
                         const std::vector<VkDescriptorType>& types = kTypes) {
  std::vector<VkDescriptorPoolSize> sizes;
  for (const VkDescriptorType type : types) sizes.push_back({type, 1});
  VkDescriptorPoolCreateInfo info{
      VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, nullptr, 0, 1, uint32_t(sizes.size()), sizes.data()};
  VkDescriptorPool pool = nullptr;
  check(vkCreateDescriptorPool(client.device, &info, nullptr, &pool), "vkCreateDescriptorPool");
  client.at_end([device = client.device, pool] { vkDestroyDescriptorPool(device, pool, nullptr); });
  const VkDescriptorSetAllocateInfo wanted{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, pool, 1,
                                           &layout};
  VkDescriptorSet out = nullptr;
  check(vkAllocateDescriptorSets(client.device, &wanted, &out), "vkAllocateDescriptorSets");
  return out;
}

MappedBuffer untouched(RayClient& client) {
  const MappedBuffer out = client.buffer_with_address(256);
  for (uint32_t& each : out.as<uint32_t>()) each = kUntouched;
  return out;
}

void require_nothing(const MappedBuffer& out) {
  for (uint32_t i = 0; i + 1 < kAnswers; ++i) {
    CAPTURE(i);
    REQUIRE(out.as<uint32_t>()[i] == 0);
  }
  REQUIRE(out.as<uint32_t>()[kAnswers - 1] == 77);
  REQUIRE(out.as<uint32_t>()[kAnswers] == kUntouched);
}

VkSampler any_sampler(Client& client) {
  return client.sampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
}

TEST_CASE("null descriptors of a set give 0, drop stores, and let rays miss", "[nulls]") {
  NullClient client;
  const MappedBuffer out = untouched(client);
  const ComputePipeline pipeline = client.pipeline(kShader, {kTypes});
  const VkDescriptorSet set = allocate(client, pipeline.set_layout);
  const Writes writes(out.buffer, any_sampler(client), set);
  vkUpdateDescriptorSets(client.device, uint32_t(writes.all.size()), writes.all.data(), 0, nullptr);

  REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);

  require_nothing(out);
  CHECK(client.messages.empty());
}

TEST_CASE("null descriptors of a set are copied as such") {
  NullClient client;
  const MappedBuffer out = untouched(client);
  const ComputePipeline pipeline = client.pipeline(kShader, {kTypes});
  const VkDescriptorSet from = allocate(client, pipeline.set_layout),
                        to = allocate(client, pipeline.set_layout);
  const Writes writes(out.buffer, any_sampler(client), from);
  vkUpdateDescriptorSets(client.device, uint32_t(writes.all.size()), writes.all.data(), 0, nullptr);
  std::vector<VkCopyDescriptorSet> copies;
  for (uint32_t i = 0; i < kTypes.size(); ++i)
    copies.push_back({VK_STRUCTURE_TYPE_COPY_DESCRIPTOR_SET, nullptr, from, i, 0, to, i, 0, 1});
  vkUpdateDescriptorSets(client.device, 0, nullptr, uint32_t(copies.size()), copies.data());

  REQUIRE(client.dispatch(pipeline, to, {1, 1, 1}) == VK_SUCCESS);

  require_nothing(out);
  CHECK(client.messages.empty());
}

TEST_CASE("null descriptors are pushed") {
  NullClient client;
  const MappedBuffer out = untouched(client);
  const ComputePipeline pipeline = client.pipeline(
      kShader, {.bindings = kTypes, .set_flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR});
  const Writes writes(out.buffer, any_sampler(client), nullptr);
  const auto push = client.load<PFN_vkCmdPushDescriptorSetKHR>("vkCmdPushDescriptorSetKHR");

  REQUIRE(client.run([&](VkCommandBuffer commands) {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
    push(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, uint32_t(writes.all.size()),
         writes.all.data());
    vkCmdDispatch(commands, 1, 1, 1);
  }) == VK_SUCCESS);

  require_nothing(out);
  CHECK(client.messages.empty());
}

// Puts the descriptors of a set into a buffer. Those of nothing come from null pointers.
void put_all(NullClient& client, const ComputePipeline& pipeline, const MappedBuffer& out,
             const MappedBuffer& to) {
  const auto place =
      client.load<PFN_vkGetDescriptorSetLayoutBindingOffsetEXT>("vkGetDescriptorSetLayoutBindingOffsetEXT");
  const auto get = client.load<PFN_vkGetDescriptorEXT>("vkGetDescriptorEXT");
  const VkDescriptorAddressInfoEXT answers{VK_STRUCTURE_TYPE_DESCRIPTOR_ADDRESS_INFO_EXT, nullptr,
                                           client.address(out), kAnswers * sizeof(uint32_t),
                                           VK_FORMAT_UNDEFINED};
  const VkDescriptorImageInfo no_image{any_sampler(client), nullptr, VK_IMAGE_LAYOUT_GENERAL};
  for (uint32_t i = 0; i < kTypes.size(); ++i) {
    VkDeviceSize offset = 0;
    place(client.device, pipeline.set_layout, i, &offset);
    VkDescriptorGetInfoEXT info{VK_STRUCTURE_TYPE_DESCRIPTOR_GET_INFO_EXT, nullptr, kTypes[i], {}};
    if (i == 0) info.data.pStorageBuffer = &answers;
    if (kTypes[i] == kSampled) info.data.pCombinedImageSampler = &no_image;
    get(client.device, &info, 32, static_cast<std::byte*>(to.data) + offset);
  }
}

TEST_CASE("null descriptors lie in descriptor buffers, and ranges there end where they say") {
  NullClient client;
  const MappedBuffer out = untouched(client), descriptors = client.buffer_with_address(1024);
  std::string shader = kShader;
  shader.replace(shader.rfind('}'), 1, "  v[i++] = 5u; v[i] = v[i - 1]; }");  // past the range
  const ComputePipeline pipeline =
      client.pipeline(shader, {.bindings = kTypes,
                               .set_flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_DESCRIPTOR_BUFFER_BIT_EXT,
                               .flags = VK_PIPELINE_CREATE_DESCRIPTOR_BUFFER_BIT_EXT});
  put_all(client, pipeline, out, descriptors);

  REQUIRE(client.run([&](VkCommandBuffer commands) {
    const VkDescriptorBufferBindingInfoEXT bound{VK_STRUCTURE_TYPE_DESCRIPTOR_BUFFER_BINDING_INFO_EXT,
                                                 nullptr, client.address(descriptors),
                                                 VK_BUFFER_USAGE_RESOURCE_DESCRIPTOR_BUFFER_BIT_EXT};
    const uint32_t first = 0;
    const VkDeviceSize offset = 0;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
    client.load<PFN_vkCmdBindDescriptorBuffersEXT>("vkCmdBindDescriptorBuffersEXT")(commands, 1, &bound);
    client.load<PFN_vkCmdSetDescriptorBufferOffsetsEXT>("vkCmdSetDescriptorBufferOffsetsEXT")(
        commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &first, &offset);
    vkCmdDispatch(commands, 1, 1, 1);
  }) == VK_SUCCESS);

  require_nothing(out);
  REQUIRE(client.messages.size() == 1);
  CHECK(client.messages[0].find("writes 4 bytes") != std::string::npos);
  CHECK(client.messages[0].find("84 bytes at address") != std::string::npos);
}

TEST_CASE("without nullDescriptor the use of a null handle is named") {
  NullClient client(false);
  const MappedBuffer out = untouched(client);
  const ComputePipeline pipeline = client.pipeline(kShader, {kTypes});
  const VkDescriptorSet set = allocate(client, pipeline.set_layout);
  const Writes writes(out.buffer, any_sampler(client), set);
  vkUpdateDescriptorSets(client.device, uint32_t(writes.all.size()), writes.all.data(), 0, nullptr);

  REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);

  require_nothing(out);
  REQUIRE(client.messages.size() == 1);
  CHECK(client.messages[0].find("set 0 binding 1, to which nothing is bound") != std::string::npos);
  CHECK(client.messages[0].find("set 0 binding 6") != std::string::npos);
}

TEST_CASE("of an array some buffers may be null") {
  NullClient client;
  const MappedBuffer out = untouched(client), in = client.buffer(64);
  std::iota(in.as<uint32_t>().begin(), in.as<uint32_t>().end(), 100);
  const ComputePipeline pipeline = client.pipeline(
      "#version 460\nlayout(local_size_x = 3) in;\n"
      "layout(set = 0, binding = 0) buffer Out { uint v[]; };\n"
      "layout(set = 0, binding = 1) buffer In { uint x[]; } all[3];\n"
      "void main() { uint i = gl_LocalInvocationIndex;\n"
      "  v[i] = all[i].x[2] + 1000u * all[i].x.length(); all[i].x[3] = 1u; }\n",
      {.bindings = {kStorage, kStorage}, .counts = {1, 3}});
  const VkDescriptorSet set = allocate(client, pipeline.set_layout, std::vector(4, kStorage));
  const VkDescriptorBufferInfo buffers[] = {{out.buffer, 0, VK_WHOLE_SIZE},
                                            {in.buffer, 0, VK_WHOLE_SIZE},
                                            {nullptr, 0, VK_WHOLE_SIZE},
                                            {in.buffer, 16, 16}};
  VkWriteDescriptorSet write{};
  write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, write.dstSet = set;
  write.descriptorCount = 4, write.descriptorType = kStorage, write.pBufferInfo = buffers;
  vkUpdateDescriptorSets(client.device, 1, &write, 0, nullptr);

  REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);

  CHECK(out.as<uint32_t>()[0] == 102 + 16'000);
  CHECK(out.as<uint32_t>()[1] == 0);
  CHECK(out.as<uint32_t>()[2] == 106 + 4'000);
  CHECK(in.as<uint32_t>()[3] == 1);
  CHECK(client.messages.empty());
}

TEST_CASE("with robustBufferAccess2 and robustImageAccess2 what leaves a range or an image is 0") {
  VkPhysicalDeviceRobustness2FeaturesEXT robust{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ROBUSTNESS_2_FEATURES_EXT,
                                                nullptr, VK_TRUE, VK_TRUE, VK_FALSE};
  Client::Options options;
  options.extensions = {VK_EXT_ROBUSTNESS_2_EXTENSION_NAME}, options.more_features = &robust;
  options.features.robustBufferAccess = VK_TRUE;
  Client client(options);
  const MappedBuffer buffer = client.buffer(128);
  for (uint32_t& each : buffer.as<uint32_t>()) each = kUntouched;
  const BoundImage image = client.image(VK_FORMAT_R32_SFLOAT, {4, 4, 1});
  const ComputePipeline pipeline = client.pipeline(
      "#version 460\nlayout(local_size_x = 1) in;\n"
      "layout(set = 0, binding = 0) buffer Words { uvec4 v[]; };\n"
      "layout(set = 0, binding = 1, r32f) uniform image2D picture;\n"
      "void main() { vec4 texel = imageLoad(picture, ivec2(4, 0));\n"
      "  v[0] = floatBitsToUint(texel); v[1] = uvec4(1); v[2] = uvec4(2);\n"
      "  v[0].y = v[2].x + 10u * v[3].w + v.length(); }\n",
      {.bindings = {kStorage, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}});
  const VkDescriptorSet set =
      client.set_with_image(pipeline.set_layout, buffer, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                            {nullptr, image.view, VK_IMAGE_LAYOUT_GENERAL});
  const VkDescriptorBufferInfo range{buffer.buffer, 0, 36};  // ends within v[2]
  VkWriteDescriptorSet write{};
  write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, write.dstSet = set;
  write.descriptorCount = 1, write.descriptorType = kStorage, write.pBufferInfo = &range;
  vkUpdateDescriptorSets(client.device, 1, &write, 0, nullptr);

  REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);

  const auto got = buffer.as<uint32_t>();
  const uint32_t one = 0x3f80'0000;  // the alpha of a format without one
  CHECK(std::vector<uint32_t>(got.begin(), got.begin() + 10) ==
        std::vector<uint32_t>{0, 2 + 2, 0, one, 1, 1, 1, 1, 2, kUntouched});
  CHECK(client.messages.empty());
}

}  // namespace
}  // namespace glint::test::null_descriptor_test
