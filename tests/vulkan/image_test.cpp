// Tests images over the Vulkan loader: storing, sampling, copies, clears and blits.
// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

#include "tests/support/catch.h"
#include "tests/vulkan/client.h"

// Tests with the tag [graphics] use commands that only graphics queues have in Vulkan; Glint's queue has them
// too.
namespace glint::test::image_test {
namespace {

constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkDescriptorType kStorageImage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
constexpr VkDescriptorType kTexture = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;

// Returns what a copy brings of an image to which a shader has stored x, y and 255 - x as red, green and
// blue. `layout` is the image's declaration in the shader.
std::vector<uint32_t> stored_picture(VkFormat format, const std::string& layout, VkExtent3D extent) {
  Client client;
  const BoundImage image = client.image(format, extent);
  const size_t texels = extent.width * extent.height;
  const MappedBuffer out = client.buffer(texels * 4);
  const ComputePipeline pipeline =
      client.pipeline("#version 460\nlayout(local_size_x = 8, local_size_y = 8) in;\n" + layout +
                          " uniform writeonly image2D picture;\n"
                          "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
                          "  imageStore(picture, p, vec4(p.x, p.y, 255 - p.x, 255) / 255.0); }\n",
                      {{kStorage, kStorageImage}});
  const VkDescriptorSet set = client.set_with_image(pipeline.set_layout, out, kStorageImage,
                                                    {nullptr, image.view, VK_IMAGE_LAYOUT_GENERAL});

  REQUIRE(client.dispatch(pipeline, set, {extent.width / 8, extent.height / 8, 1}) == VK_SUCCESS);
  REQUIRE(client.download(image, out, extent) == VK_SUCCESS);
  const auto words = out.as<uint32_t>().first(texels);
  return {words.begin(), words.end()};
}

TEST_CASE("what a shader stores to an image is what a copy brings to a buffer", "[portable]") {
  const std::vector<uint32_t> out =
      stored_picture(VK_FORMAT_R8G8B8A8_UNORM, "layout(set = 0, binding = 1, rgba8)", {16, 8, 1});
  for (uint32_t y = 0; y < 8; ++y)
    for (uint32_t x = 0; x < 16; ++x) REQUIRE(out[y * 16 + x] == (0xff000000 | (255 - x) << 16 | y << 8 | x));
}

// Ray tracers store to an image of their swapchain's format and copy it.
TEST_CASE("what a shader stores to an image of a swapchain's format has its channels in order") {
  const std::vector<uint32_t> out =
      stored_picture(VK_FORMAT_B8G8R8A8_UNORM, "layout(set = 0, binding = 1)", {8, 8, 1});
  for (uint32_t y = 0; y < 8; ++y)
    for (uint32_t x = 0; x < 8; ++x) REQUIRE(out[y * 8 + x] == (0xff000000 | x << 16 | y << 8 | (255 - x)));
}

TEST_CASE("a linear sampler blends texels, and the view's swizzle orders their channels", "[portable]") {
  Client client;
  const VkExtent3D extent{2, 1, 1};
  const BoundImage image = client.image(
      VK_FORMAT_R32G32B32A32_SFLOAT, extent, 1, 1,
      {VK_COMPONENT_SWIZZLE_G, VK_COMPONENT_SWIZZLE_R, VK_COMPONENT_SWIZZLE_ONE, VK_COMPONENT_SWIZZLE_ZERO});
  const MappedBuffer texels = client.buffer(32), out = client.buffer(16);
  const std::array<float, 8> values{1, 10, 100, 1000, 3, 20, 200, 2000};
  std::memcpy(texels.data, values.data(), sizeof values);
  REQUIRE(client.upload(texels, image, extent) == VK_SUCCESS);
  const ComputePipeline pipeline = client.pipeline(
      "#version 460\nlayout(local_size_x = 1) in;\nlayout(set = 0, binding = 0) buffer O { vec4 v; };\n"
      "layout(set = 0, binding = 1) uniform sampler2D picture;\n"
      "void main() { v = textureLod(picture, vec2(0.5, 0.5), 0); }\n",
      {{kStorage, kTexture}});
  const VkSampler linear = client.sampler(VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  const VkDescriptorSet set = client.set_with_image(pipeline.set_layout, out, kTexture,
                                                    {linear, image.view, VK_IMAGE_LAYOUT_GENERAL});

  REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);

  CHECK(out.as<float>()[0] == 15);
  CHECK(out.as<float>()[1] == 2);
  CHECK(out.as<float>()[2] == 1);
  CHECK(out.as<float>()[3] == 0);
}

TEST_CASE("copies between images move boxes, layers and slices", "[portable]") {
  Client client;
  const VkExtent3D flat{4, 4, 1}, deep{4, 4, 2};
  const BoundImage layered = client.image(VK_FORMAT_R32_UINT, flat, 1, 2);
  const BoundImage slices = client.image(VK_FORMAT_R32_UINT, deep);
  const MappedBuffer in = client.buffer(128), out = client.buffer(128);
  std::iota(in.as<uint32_t>().begin(), in.as<uint32_t>().end(), 0u);
  REQUIRE(client.upload(in, layered, flat) == VK_SUCCESS);

  REQUIRE(client.run([&](VkCommandBuffer commands) {
    const VkClearColorValue nines{.uint32 = {9, 9, 9, 9}};
    vkCmdClearColorImage(commands, slices.image, VK_IMAGE_LAYOUT_GENERAL, &nines, 1, &slices.all);
    const VkMemoryBarrier all{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_TRANSFER_WRITE_BIT,
                              VK_ACCESS_TRANSFER_WRITE_BIT};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1, &all,
                         0, nullptr, 0, nullptr);
    const VkImageCopy region{{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 2},
                             {1, 0, 0},
                             {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                             {0, 1, 0},
                             {3, 2, 2}};
    vkCmdCopyImage(commands, layered.image, VK_IMAGE_LAYOUT_GENERAL, slices.image, VK_IMAGE_LAYOUT_GENERAL, 1,
                   &region);
  }) == VK_SUCCESS);
  REQUIRE(client.download(slices, out, deep) == VK_SUCCESS);

  for (uint32_t z = 0; z < 2; ++z)
    for (uint32_t y = 0; y < 4; ++y)
      for (uint32_t x = 0; x < 4; ++x) {
        const bool is_copied = x < 3 && y >= 1 && y < 3;
        REQUIRE(out.as<uint32_t>()[(z * 4 + y) * 4 + x] == (is_copied ? z * 16 + (y - 1) * 4 + x + 1 : 9));
      }
}

TEST_CASE("a blit halves and mirrors a picture", "[portable][graphics]") {
  Client client;
  const VkExtent3D large{4, 2, 1}, small{2, 1, 1};
  const BoundImage from = client.image(VK_FORMAT_R32_SFLOAT, large),
                   to = client.image(VK_FORMAT_R32_SFLOAT, small);
  const MappedBuffer in = client.buffer(32), out = client.buffer(8);
  const std::array<float, 8> values{1, 3, 10, 30, 5, 7, 50, 70};
  std::memcpy(in.data, values.data(), sizeof values);
  REQUIRE(client.upload(in, from, large) == VK_SUCCESS);

  REQUIRE(client.run([&](VkCommandBuffer commands) {
    const VkImageSubresourceLayers all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    const VkImageBlit region{all, {{4, 0, 0}, {0, 2, 1}}, all, {{0, 0, 0}, {2, 1, 1}}};
    vkCmdBlitImage(commands, from.image, VK_IMAGE_LAYOUT_GENERAL, to.image, VK_IMAGE_LAYOUT_GENERAL, 1,
                   &region, VK_FILTER_LINEAR);
  }) == VK_SUCCESS);
  REQUIRE(client.download(to, out, small) == VK_SUCCESS);

  CHECK(out.as<float>()[0] == 40);
  CHECK(out.as<float>()[1] == 4);
}

// Stores to each sample of an image, fetches from a copy of it, and takes the mean.
void check_samples(VkSampleCountFlagBits count) {
  Client::Options options;
  options.features.shaderStorageImageMultisample = VK_TRUE;
  Client client(options);
  const VkExtent3D extent{4, 2, 1};
  const BoundImage samples = client.image(VK_FORMAT_R32G32B32A32_SFLOAT, extent, 1, 1, {}, count);
  const BoundImage copied = client.image(VK_FORMAT_R32G32B32A32_SFLOAT, extent, 1, 1, {}, count);
  const BoundImage mean = client.image(VK_FORMAT_R32G32B32A32_SFLOAT, extent);
  const MappedBuffer out = client.buffer(8 * 16), fetched = client.buffer(8 * 4);
  const std::string head = "#version 460\nlayout(local_size_x = 4, local_size_y = 2) in;\n";
  const std::string place = "void main() { ivec2 p = ivec2(gl_LocalInvocationID.xy);\n";
  const ComputePipeline store = client.pipeline(
      head + "layout(set = 0, binding = 1, rgba32f) uniform writeonly image2DMS picture;\n" + place +
          "for (int s = 0; s < imageSamples(picture); ++s) imageStore(picture, p, s, vec4(p.x + 10 * p.y, s "
          "* s, s, 1)); }\n",
      {{kStorage, kStorageImage}});
  const ComputePipeline fetch =
      client.pipeline(head + "layout(set = 0, binding = 0) buffer F { float f[]; };\n" +
                          "layout(set = 0, binding = 1) uniform sampler2DMS picture;\n" + place +
                          "f[p.y * 4 + p.x] = texelFetch(picture, p, p.x % textureSamples(picture)).y + 100 "
                          "* textureSamples(picture); }\n",
                      {{kStorage, kTexture}});
  const VkSampler sampler = client.sampler(VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  const VkDescriptorSet to_store = client.set_with_image(store.set_layout, fetched, kStorageImage,
                                                         {nullptr, samples.view, VK_IMAGE_LAYOUT_GENERAL});
  const VkDescriptorSet to_fetch = client.set_with_image(fetch.set_layout, fetched, kTexture,
                                                         {sampler, copied.view, VK_IMAGE_LAYOUT_GENERAL});

  REQUIRE(client.dispatch(store, to_store, {1, 1, 1}) == VK_SUCCESS);
  REQUIRE(client.run([&](VkCommandBuffer commands) {
    const VkImageSubresourceLayers all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    const VkImageCopy copy{all, {}, all, {}, extent};
    vkCmdCopyImage(commands, samples.image, VK_IMAGE_LAYOUT_GENERAL, copied.image, VK_IMAGE_LAYOUT_GENERAL, 1,
                   &copy);
    const VkImageResolve resolve{all, {1, 0, 0}, all, {0, 0, 0}, {3, 2, 1}};
    vkCmdResolveImage(commands, samples.image, VK_IMAGE_LAYOUT_GENERAL, mean.image, VK_IMAGE_LAYOUT_GENERAL,
                      1, &resolve);
  }) == VK_SUCCESS);
  REQUIRE(client.dispatch(fetch, to_fetch, {1, 1, 1}) == VK_SUCCESS);
  REQUIRE(client.download(mean, out, extent) == VK_SUCCESS);

  const auto n = uint32_t(count);
  for (uint32_t y = 0; y < 2; ++y)
    for (uint32_t x = 0; x < 4; ++x) {
      REQUIRE(fetched.as<float>()[y * 4 + x] == float(100 * n + (x % n) * (x % n)));
      if (x == 3) continue;
      const float* const texel = &out.as<float>()[(y * 4 + x) * 4];
      CHECK(texel[0] == float(x + 1 + 10 * y));
      CHECK(texel[1] == float((n - 1) * (2 * n - 1)) / 6.0f);
      CHECK(texel[2] == float(n - 1) / 2.0f);
    }
}

TEST_CASE("a shader stores and fetches each sample, and a resolve takes their mean", "[portable][graphics]") {
  check_samples(VK_SAMPLE_COUNT_4_BIT);
}

TEST_CASE("images of 2, 8 and 16 samples are stored to, fetched and resolved") {
  check_samples(GENERATE(VK_SAMPLE_COUNT_2_BIT, VK_SAMPLE_COUNT_8_BIT, VK_SAMPLE_COUNT_16_BIT));
}

TEST_CASE("a clear of a stencil image takes the stencil's value", "[graphics]") {
  Client client;
  const VkExtent3D extent{4, 2, 1};
  BoundImage stencil = client.image(VK_FORMAT_S8_UINT, extent);
  stencil.all.aspectMask = VK_IMAGE_ASPECT_STENCIL_BIT;
  const MappedBuffer out = client.buffer(8);

  REQUIRE(client.run([&](VkCommandBuffer commands) {
    const VkClearDepthStencilValue value{0.5f, 77};
    vkCmdClearDepthStencilImage(commands, stencil.image, VK_IMAGE_LAYOUT_GENERAL, &value, 1, &stencil.all);
  }) == VK_SUCCESS);
  REQUIRE(client.download(stencil, out, extent) == VK_SUCCESS);

  for (const uint8_t each : out.as<uint8_t>()) REQUIRE(each == 77);
}

TEST_CASE("a sample that an image lacks is dropped and does not meet the next layer") {
  Client::Options options;
  options.features.shaderStorageImageMultisample = options.features.robustBufferAccess = VK_TRUE;
  Client client(options);
  const VkExtent3D extent{2, 2, 1};
  const BoundImage layers = client.image(VK_FORMAT_R32_UINT, extent, 1, 2, {}, VK_SAMPLE_COUNT_4_BIT);
  const MappedBuffer out = client.buffer(2 * 4);
  REQUIRE(client.run([&](VkCommandBuffer commands) {
    const VkClearColorValue fives{.uint32 = {5, 0, 0, 0}};
    vkCmdClearColorImage(commands, layers.image, VK_IMAGE_LAYOUT_GENERAL, &fives, 1, &layers.all);
  }) == VK_SUCCESS);
  const ComputePipeline pipeline = client.pipeline(
      "#version 460\nlayout(local_size_x = 1) in;\nlayout(set = 0, binding = 0) buffer O { uint o[2]; };\n"
      "layout(set = 0, binding = 1, r32ui) uniform uimage2DMSArray picture;\n"
      "void main() { imageStore(picture, ivec3(0), int(gl_NumWorkGroups.x) + 3, uvec4(9));\n"
      "  imageStore(picture, ivec3(1, 0, 1), 3, uvec4(8));\n"
      "  o[0] = imageLoad(picture, ivec3(0, 0, 1), 0).x; o[1] = imageLoad(picture, ivec3(1, 0, 1), 3).x; }\n",
      {{kStorage, kStorageImage}});
  const VkDescriptorSet set = client.set_with_image(pipeline.set_layout, out, kStorageImage,
                                                    {nullptr, layers.view, VK_IMAGE_LAYOUT_GENERAL});

  REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);

  CHECK(out.as<uint32_t>()[0] == 5);
  CHECK(out.as<uint32_t>()[1] == 8);
}

TEST_CASE("a resolve of an image with one sample is refused, and so is a copy of four to a buffer") {
  Client client;
  const VkExtent3D extent{4, 4, 1};
  const BoundImage one = client.image(VK_FORMAT_R32_UINT, extent),
                   other = client.image(VK_FORMAT_R32_UINT, extent);
  const BoundImage four = client.image(VK_FORMAT_R32_UINT, extent, 1, 1, {}, VK_SAMPLE_COUNT_4_BIT);
  const MappedBuffer out = client.buffer(64);

  CHECK(client.run([&](VkCommandBuffer commands) {
    const VkImageSubresourceLayers all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    const VkImageResolve region{all, {}, all, {}, extent};
    vkCmdResolveImage(commands, one.image, VK_IMAGE_LAYOUT_GENERAL, other.image, VK_IMAGE_LAYOUT_GENERAL, 1,
                      &region);
  }) == VK_ERROR_VALIDATION_FAILED_EXT);
  CHECK(client.download(four, out, extent) == VK_ERROR_VALIDATION_FAILED_EXT);
}

TEST_CASE("a format that shaders cannot store to is not announced as a storage image") {
  Client client;
  VkImageFormatProperties properties;
  CHECK(vkGetPhysicalDeviceImageFormatProperties(client.physical, VK_FORMAT_R8G8B8A8_SRGB, VK_IMAGE_TYPE_2D,
                                                 VK_IMAGE_TILING_OPTIMAL, VK_IMAGE_USAGE_STORAGE_BIT, 0,
                                                 &properties) == VK_ERROR_FORMAT_NOT_SUPPORTED);
  CHECK(vkGetPhysicalDeviceImageFormatProperties(client.physical, VK_FORMAT_R8G8B8A8_SRGB, VK_IMAGE_TYPE_2D,
                                                 VK_IMAGE_TILING_OPTIMAL, VK_IMAGE_USAGE_SAMPLED_BIT, 0,
                                                 &properties) == VK_SUCCESS);
  CHECK(properties.maxMipLevels == 15);
}

TEST_CASE("atomics change integers of 64 bits and floats in images") {
  VkPhysicalDeviceShaderAtomicFloatFeaturesEXT floats{};
  floats.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_ATOMIC_FLOAT_FEATURES_EXT;
  floats.shaderImageFloat32AtomicAdd = VK_TRUE;
  VkPhysicalDeviceShaderImageAtomicInt64FeaturesEXT integers{};
  integers.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_IMAGE_ATOMIC_INT64_FEATURES_EXT;
  integers.pNext = &floats, integers.shaderImageInt64Atomics = VK_TRUE;
  Client::Options options;
  options.extensions = {"VK_EXT_shader_atomic_float", "VK_EXT_shader_image_atomic_int64"};
  options.features.shaderInt64 = VK_TRUE, options.more_features = &integers;
  Client client(options);
  const VkExtent3D extent{2, 1, 1};
  const MappedBuffer out = client.buffer(16);
  const auto changed = [&](VkFormat format, const std::string& declaration, const std::string& change) {
    VkFormatProperties can;
    vkGetPhysicalDeviceFormatProperties(client.physical, format, &can);
    CHECK(can.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_ATOMIC_BIT);
    const BoundImage image = client.image(format, extent);
    REQUIRE(client.run([&](VkCommandBuffer commands) {
      const VkClearColorValue zero{};
      vkCmdClearColorImage(commands, image.image, VK_IMAGE_LAYOUT_GENERAL, &zero, 1, &image.all);
    }) == VK_SUCCESS);
    const ComputePipeline pipeline = client.pipeline(
        "#version 460\n#extension GL_EXT_shader_atomic_float : require\n"
        "#extension GL_EXT_shader_image_int64 : require\n"
        "#extension GL_EXT_shader_explicit_arithmetic_types : require\nlayout(local_size_x = 32) in;\n"
        "layout(set = 0, binding = 0) buffer O { uint o; };\nlayout(set = 0, binding = 1, " +
            declaration + " picture;\nvoid main() { " + change + " }\n",
        {{kStorage, kStorageImage}});
    const VkDescriptorSet set = client.set_with_image(pipeline.set_layout, out, kStorageImage,
                                                      {nullptr, image.view, VK_IMAGE_LAYOUT_GENERAL});
    REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);
    REQUIRE(client.download(image, out, extent) == VK_SUCCESS);
  };

  changed(VK_FORMAT_R64_UINT, "r64ui) uniform u64image2D",
          "imageAtomicAdd(picture, ivec2(1, 0), 0x100000001ul);");
  CHECK(out.as<uint64_t>()[1] == 0x20'0000'0020);
  changed(VK_FORMAT_R32_SFLOAT, "r32f) uniform image2D", "imageAtomicAdd(picture, ivec2(1, 0), 0.5);");
  CHECK(out.as<float>()[1] == 16);
}

}  // namespace
}  // namespace glint::test::image_test
