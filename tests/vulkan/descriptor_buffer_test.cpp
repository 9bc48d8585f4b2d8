// Tests descriptors that lie in buffers of the application (VK_EXT_descriptor_buffer).
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/catch.h"
#include "tests/vulkan/ray_client.h"

namespace glint::test::descriptor_buffer_test {
namespace {

constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkDescriptorType kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
constexpr VkDescriptorType kTexels = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
constexpr VkDescriptorType kSampled = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
constexpr VkDescriptorType kInline = VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK;
constexpr VkDescriptorType kStructure = VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR;
const std::string kHead =
    "#version 460\n#extension GL_EXT_ray_query : enable\n"
    "#extension GL_EXT_samplerless_texture_functions : enable\nlayout(local_size_x = 8) in;\n";
const std::string kOut = kHead + "layout(set = 0, binding = 0) buffer Out { uint v[]; };\n";

const void* wanted_features() {
  static const VkPhysicalDeviceDescriptorBufferFeaturesEXT features{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DESCRIPTOR_BUFFER_FEATURES_EXT,
      nullptr,
      VK_TRUE,
      0,
      VK_TRUE,
      VK_TRUE};
  return &features;
}

// Is a program that keeps its descriptors in a buffer.
class Keeper : public RayClient {
 public:
  Keeper() : RayClient({"VK_EXT_descriptor_buffer"}, wanted_features()) {
    sizes.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DESCRIPTOR_BUFFER_PROPERTIES_EXT;
    VkPhysicalDeviceProperties2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &sizes, {}};
    vkGetPhysicalDeviceProperties2(physical, &all);
    descriptors = buffer_with_address(4096);
    std::memset(descriptors.data, 0, descriptors.bytes);
  }

  ComputePipeline pipeline_of(const std::string& glsl, std::vector<VkDescriptorType> types) {
    return pipeline(glsl, {.bindings = std::move(types),
                           .set_flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_DESCRIPTOR_BUFFER_BIT_EXT,
                           .inline_bytes = 16,
                           .flags = VK_PIPELINE_CREATE_DESCRIPTOR_BUFFER_BIT_EXT});
  }

  // Returns where the descriptor of a binding lies in the buffer of descriptors.
  std::byte* place(const ComputePipeline& pipeline, uint32_t binding) {
    VkDeviceSize offset = 0;
    load<PFN_vkGetDescriptorSetLayoutBindingOffsetEXT>("vkGetDescriptorSetLayoutBindingOffsetEXT")(
        device, pipeline.set_layout, binding, &offset);
    return static_cast<std::byte*>(descriptors.data) + offset;
  }
  void put(const VkDescriptorGetInfoEXT& info, size_t bytes, std::byte* to) {
    load<PFN_vkGetDescriptorEXT>("vkGetDescriptorEXT")(device, &info, bytes, to);
  }
  // Writes a descriptor of bytes of a buffer.
  void put_bytes(VkDescriptorType type, size_t size, std::byte* to, const MappedBuffer& of,
                 VkFormat format = VK_FORMAT_UNDEFINED) {
    const VkDescriptorAddressInfoEXT bytes{VK_STRUCTURE_TYPE_DESCRIPTOR_ADDRESS_INFO_EXT, nullptr,
                                           address(of), of.bytes, format};
    VkDescriptorGetInfoEXT info{VK_STRUCTURE_TYPE_DESCRIPTOR_GET_INFO_EXT, nullptr, type, {}};
    info.data.pStorageBuffer = &bytes;
    put(info, size, to);
  }

  // Records a dispatch whose set 0 begins at the start of a buffer.
  void record_dispatch(VkCommandBuffer commands, const ComputePipeline& pipeline, const MappedBuffer& from) {
    const VkDescriptorBufferBindingInfoEXT bound{VK_STRUCTURE_TYPE_DESCRIPTOR_BUFFER_BINDING_INFO_EXT,
                                                 nullptr, address(from),
                                                 VK_BUFFER_USAGE_RESOURCE_DESCRIPTOR_BUFFER_BIT_EXT};
    const uint32_t first = 0;
    const VkDeviceSize offset = 0;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
    load<PFN_vkCmdBindDescriptorBuffersEXT>("vkCmdBindDescriptorBuffersEXT")(commands, 1, &bound);
    load<PFN_vkCmdSetDescriptorBufferOffsetsEXT>("vkCmdSetDescriptorBufferOffsetsEXT")(
        commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &first, &offset);
    vkCmdDispatch(commands, 1, 1, 1);
  }
  VkResult dispatch_stored(const ComputePipeline& pipeline) {
    return run([&](VkCommandBuffer commands) { record_dispatch(commands, pipeline, descriptors); });
  }

  VkPhysicalDeviceDescriptorBufferPropertiesEXT sizes{};
  MappedBuffer descriptors;
};

TEST_CASE("descriptors in a buffer name buffers, texels, and bytes that lie among them") {
  Keeper client;
  const MappedBuffer out = client.buffer_with_address(64), in = client.buffer_with_address(64);
  const MappedBuffer bytes =
      client.buffer(64, VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  for (uint32_t i = 0; i < 16; ++i) in.as<uint32_t>()[i] = 100 * i, bytes.as<uint32_t>()[i] = i + 1;
  const ComputePipeline pipeline =
      client.pipeline_of(kOut +
                             "layout(set = 0, binding = 1) uniform In { uvec4 in4[4]; };\n"
                             "layout(set = 0, binding = 2) uniform Among { uvec4 among; };\n"
                             "layout(set = 0, binding = 3) uniform utextureBuffer texels;\n"
                             "void main() { uint i = gl_LocalInvocationIndex;\n"
                             "  v[i] = in4[i / 4][i % 4] + among.z + texelFetch(texels, int(i)).x + "
                             "uint(textureSize(texels)); }\n",
                         {kStorage, kUniform, kInline, kTexels});
  client.put_bytes(kStorage, client.sizes.storageBufferDescriptorSize, client.place(pipeline, 0), out);
  client.put_bytes(kUniform, client.sizes.uniformBufferDescriptorSize, client.place(pipeline, 1), in);
  const uint32_t among[4] = {1, 2, 7000, 4};
  std::memcpy(client.place(pipeline, 2), among, sizeof among);
  client.put_bytes(kTexels, client.sizes.uniformTexelBufferDescriptorSize, client.place(pipeline, 3), bytes,
                   VK_FORMAT_R32_UINT);

  REQUIRE(client.dispatch_stored(pipeline) == VK_SUCCESS);

  for (uint32_t i = 0; i < 8; ++i) REQUIRE(out.as<uint32_t>()[i] == 100 * i + 7000 + i + 1 + 16);
  CHECK(client.messages.empty());
}

TEST_CASE("a launch reads the descriptors that commands before it copied into place") {
  Keeper client;
  const MappedBuffer first = client.buffer_with_address(64), second = client.buffer_with_address(64);
  std::memset(first.data, 0, first.bytes), std::memset(second.data, 0, second.bytes);
  const MappedBuffer copied = client.buffer_with_address(4096);
  const ComputePipeline pipeline =
      client.pipeline_of(kOut + "void main() { v[gl_LocalInvocationIndex] += 5u; }\n", {kStorage});
  const size_t size = client.sizes.storageBufferDescriptorSize;
  client.put_bytes(kStorage, size, client.place(pipeline, 0), first);
  client.put_bytes(kStorage, size, client.place(pipeline, 0) + 256, second);

  REQUIRE(client.run([&](VkCommandBuffer commands) {
    for (const VkDeviceSize from : {0, 256, 256}) {
      const VkBufferCopy region{from, 0, size};
      vkCmdCopyBuffer(commands, client.descriptors.buffer, copied.buffer, 1, &region);
      client.record_dispatch(commands, pipeline, copied);
    }
  }) == VK_SUCCESS);

  CHECK(first.as<uint32_t>()[3] == 5);
  CHECK(second.as<uint32_t>()[3] == 10);
}

TEST_CASE("descriptors in a buffer name images with samplers, and structures") {
  Keeper client;
  const MappedBuffer out = client.buffer_with_address(64), pixel = client.buffer(64);
  pixel.as<uint8_t>()[0] = 255, pixel.as<uint8_t>()[4] = 51;
  const BoundImage image = client.image(VK_FORMAT_R8G8B8A8_UNORM, {2, 1, 1});
  REQUIRE(client.upload(pixel, image, {2, 1, 1}) == VK_SUCCESS);
  const RayStructure square = client.build(client.triangles(unit_square()));
  const RayStructure top = client.build(client.instances({instance_at(2, 77, square.address)}));
  const ComputePipeline pipeline = client.pipeline_of(
      kOut +
          "layout(set = 0, binding = 1) uniform sampler2D picture;\n"
          "layout(set = 0, binding = 2) uniform accelerationStructureEXT scene;\n"
          "void main() { uint i = gl_LocalInvocationIndex; rayQueryEXT query;\n"
          "  rayQueryInitializeEXT(query, scene, 1, 0xff, vec3(i + 0.4, 0.3, 5), 0, vec3(0, 0, -1), 100);\n"
          "  while (rayQueryProceedEXT(query)) {}\n"
          "  bool hit = rayQueryGetIntersectionTypeEXT(query, true) != 0;\n"
          "  v[i] = (hit ? rayQueryGetIntersectionInstanceCustomIndexEXT(query, true) : 0u)\n"
          "       + 1000u * uint(round(255 * textureLod(picture, vec2((i + 0.5) / 2, 0.5), 0).x)); }\n",
      {kStorage, kSampled, kStructure});
  client.put_bytes(kStorage, client.sizes.storageBufferDescriptorSize, client.place(pipeline, 0), out);
  const VkDescriptorImageInfo sampled{
      client.sampler(VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE), image.view,
      VK_IMAGE_LAYOUT_GENERAL};
  VkDescriptorGetInfoEXT info{VK_STRUCTURE_TYPE_DESCRIPTOR_GET_INFO_EXT, nullptr, kSampled, {}};
  info.data.pCombinedImageSampler = &sampled;
  client.put(info, client.sizes.combinedImageSamplerDescriptorSize, client.place(pipeline, 1));
  info.type = kStructure, info.data.accelerationStructure = top.address;
  client.put(info, client.sizes.accelerationStructureDescriptorSize, client.place(pipeline, 2));

  REQUIRE(client.dispatch_stored(pipeline) == VK_SUCCESS);

  const auto got = out.as<uint32_t>();
  CHECK(std::vector<uint32_t>(got.begin(), got.begin() + 4) ==
        std::vector<uint32_t>{255'000, 51'000, 51'077, 51'000});
  CHECK(client.messages.empty());
}

TEST_CASE("bytes that are no descriptor of a binding's kind are a descriptor of nothing") {
  Keeper client;
  const MappedBuffer out = client.buffer_with_address(64);
  std::memset(out.data, 0, out.bytes);
  const ComputePipeline pipeline =
      client.pipeline_of(kOut +
                             "layout(set = 0, binding = 1) uniform sampler2D picture;\n"
                             "void main() { v[0] = 3u; v[1] = uint(textureLod(picture, vec2(0.5), 0).x); }\n",
                         {kStorage, kSampled});
  const size_t size = client.sizes.storageBufferDescriptorSize;
  client.put_bytes(kStorage, size, client.place(pipeline, 0), out);
  SECTION("a descriptor of another kind") {
    client.put_bytes(kStorage, size, client.place(pipeline, 1), out);
  }
  SECTION("any bytes") {
    std::memset(client.place(pipeline, 1), 0xa5, size);
  }

  REQUIRE(client.dispatch_stored(pipeline) == VK_SUCCESS);

  CHECK(out.as<uint32_t>()[0] == 3);
  CHECK(out.as<uint32_t>()[1] == 0);
  CHECK(client.messages.size() == 1);
}

TEST_CASE("a set in a descriptor buffer that is not bound is refused") {
  Keeper client;
  const ComputePipeline pipeline = client.pipeline_of(kOut + "void main() { v[0] = 3u; }\n", {kStorage});
  VkCommandBuffer commands = nullptr;

  CHECK(client.record(commands, [&](VkCommandBuffer into) {
    const uint32_t third = 2;
    const VkDeviceSize offset = 0;
    client.load<PFN_vkCmdSetDescriptorBufferOffsetsEXT>("vkCmdSetDescriptorBufferOffsetsEXT")(
        into, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout, 0, 1, &third, &offset);
  }) == VK_ERROR_VALIDATION_FAILED_EXT);

  REQUIRE(client.messages.size() == 1);
  CHECK(client.messages[0].find("set 0 lies in descriptor buffer 2, and 0 of them are bound") !=
        std::string::npos);
}

}  // namespace
}  // namespace glint::test::descriptor_buffer_test
