// Tests textures over the Vulkan loader: anisotropic samplers, and formats with blocks of texels.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/catch.h"
#include "tests/vulkan/client.h"

namespace glint::test::texture_test {
namespace {

constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkDescriptorType kTexture = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
constexpr VkDescriptorType kStorageImage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
constexpr VkImageSubresourceLayers kFirstLevel{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
constexpr VkImageLayout kGeneral = VK_IMAGE_LAYOUT_GENERAL;

Client::Options with_textures() {
  Client::Options options;
  options.features.samplerAnisotropy = options.features.textureCompressionBC = VK_TRUE;
  return options;
}

// Fills a buffer with blocks of BC4, each with one value for all of its texels.
void fill(const MappedBuffer& buffer, const std::vector<uint8_t>& values) {
  std::copy(values.begin(), values.end(), buffer.as<uint64_t>().begin());
}

// Returns the red of each texel of a level, from 0 to 255, as a shader fetches it.
std::vector<int> fetched(Client& client, VkImageView view, VkExtent3D extent, uint32_t level = 0) {
  const size_t count = size_t{extent.width} * extent.height;
  const MappedBuffer out = client.buffer(count * 4);
  const ComputePipeline pipeline = client.pipeline(
      "#version 460\nlayout(local_size_x = 1) in;\nlayout(set = 0, binding = 0) buffer O { float v[]; };\n"
      "layout(set = 0, binding = 1) uniform sampler2D picture;\n"
      "void main() { uvec3 p = gl_WorkGroupID;\n  v[p.y * gl_NumWorkGroups.x + p.x] = texelFetch(picture, "
      "ivec2(p.xy), " +
          std::to_string(level) + ").r * 255; }\n",
      {{kStorage, kTexture}});
  const VkSampler sampler = client.sampler(VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE);
  const VkDescriptorSet set =
      client.set_with_image(pipeline.set_layout, out, kTexture, {sampler, view, kGeneral});
  REQUIRE(client.dispatch(pipeline, set, {extent.width, extent.height, 1}) == VK_SUCCESS);
  std::vector<int> values;
  for (float each : out.as<float>()) values.push_back(int(each + 0.5f));
  return values;
}

// Records a copy from a buffer to an image.
VkResult copy_to(Client& client, const MappedBuffer& from, const BoundImage& to,
                 const VkBufferImageCopy& region) {
  return client.run([&](VkCommandBuffer commands) {
    vkCmdCopyBufferToImage(commands, from.buffer, to.image, kGeneral, 1, &region);
  });
}

TEST_CASE("an anisotropic sampler takes the mean along the longer gradient") {
  Client client(with_textures());
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(client.physical, &properties);
  CHECK(properties.limits.maxSamplerAnisotropy == 16);
  const VkExtent3D extent{16, 16, 1};
  const BoundImage image = client.image(VK_FORMAT_R32_SFLOAT, extent);
  const MappedBuffer texels = client.buffer(16 * 16 * 4), out = client.buffer(3 * 4);
  for (size_t i = 0; i < 256; ++i) texels.as<float>()[i] = i % 16 < 8 ? 0.0f : 1.0f;
  REQUIRE(client.upload(texels, image, extent) == VK_SUCCESS);
  const ComputePipeline pipeline = client.pipeline(
      "#version 460\nlayout(local_size_x = 1) in;\nlayout(set = 0, binding = 0) buffer O { float v[3]; };\n"
      "layout(set = 0, binding = 1) uniform sampler2D picture;\n"
      "void main() { vec2 p = vec2(8.5, 8.5) / 16;\n"
      "  v[0] = textureGrad(picture, p, vec2(0.5, 0), vec2(0, 2 / 16.0)).r;\n"
      "  v[1] = textureGrad(picture, p, vec2(2 / 16.0, 0), vec2(0, 0.5)).r;\n"
      "  v[2] = textureLod(picture, p, 2).r; }\n",
      {{kStorage, kTexture}});
  const VkSampler sampler = client.sampler(VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, 16);
  const VkDescriptorSet set =
      client.set_with_image(pipeline.set_layout, out, kTexture, {sampler, image.view, kGeneral});

  REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);

  // The four samples lie 2.4 and 0.8 texels to either side of texel 8, of which those at 6.1 and 7.7 are
  // dark.
  CHECK(out.as<float>()[0] == 0.5f);
  CHECK(out.as<float>()[1] == 1.0f);
  CHECK(out.as<float>()[2] == 1.0f);
}

TEST_CASE("a sampler with a border colour of its own shows it outside of the image", "[portable]") {
  VkPhysicalDeviceCustomBorderColorFeaturesEXT border{};
  border.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CUSTOM_BORDER_COLOR_FEATURES_EXT;
  border.customBorderColors = border.customBorderColorWithoutFormat = VK_TRUE;
  Client::Options options;
  options.extensions = {"VK_EXT_custom_border_color"}, options.more_features = &border;
  Client client(options);
  const BoundImage image = client.image(VK_FORMAT_R32G32B32A32_SFLOAT, {2, 2, 1});
  const MappedBuffer out = client.buffer(16);
  const ComputePipeline pipeline = client.pipeline(
      "#version 460\nlayout(local_size_x = 1) in;\nlayout(set = 0, binding = 0) buffer O { vec4 v; };\n"
      "layout(set = 0, binding = 1) uniform sampler2D picture;\n"
      "void main() { v = textureLod(picture, vec2(-1), 0); }\n",
      {{kStorage, kTexture}});
  const VkSamplerCustomBorderColorCreateInfoEXT colour{
      VK_STRUCTURE_TYPE_SAMPLER_CUSTOM_BORDER_COLOR_CREATE_INFO_EXT,
      nullptr,
      {.float32 = {0.25f, 0.5f, 2, -3}},
      VK_FORMAT_UNDEFINED};
  VkSamplerCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO, info.pNext = &colour;
  info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
  info.borderColor = VK_BORDER_COLOR_FLOAT_CUSTOM_EXT;
  VkSampler sampler = nullptr;
  check(vkCreateSampler(client.device, &info, nullptr, &sampler), "vkCreateSampler");
  client.at_end([&client, sampler] { vkDestroySampler(client.device, sampler, nullptr); });
  const VkDescriptorSet set =
      client.set_with_image(pipeline.set_layout, out, kTexture, {sampler, image.view, kGeneral});
  REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);
  CHECK(out.as<float>()[0] == 0.25f);
  CHECK(out.as<float>()[1] == 0.5f);
  CHECK(out.as<float>()[2] == 2);
  CHECK(out.as<float>()[3] == -3);
}

TEST_CASE("a sampler finds the extremes of the texels that it filters", "[portable]") {
  VkPhysicalDeviceVulkan12Features features{};
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
  features.samplerFilterMinmax = VK_TRUE;
  Client::Options options;
  options.more_features = &features;
  Client client(options);
  VkFormatProperties can;
  vkGetPhysicalDeviceFormatProperties(client.physical, VK_FORMAT_R8_UNORM, &can);
  CHECK(can.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_MINMAX_BIT);
  const VkExtent3D extent{2, 2, 1};
  const BoundImage image = client.image(VK_FORMAT_R8_UNORM, extent);
  const MappedBuffer texels = client.buffer(4), out = client.buffer(4);
  const std::array<uint8_t, 4> values{51, 204, 102, 153};
  std::copy(values.begin(), values.end(), texels.as<uint8_t>().begin());
  REQUIRE(client.upload(texels, image, extent) == VK_SUCCESS);
  const ComputePipeline pipeline = client.pipeline(
      "#version 460\nlayout(local_size_x = 1) in;\nlayout(set = 0, binding = 0) buffer O { float v; };\n"
      "layout(set = 0, binding = 1) uniform sampler2D picture;\n"
      "void main() { v = textureLod(picture, vec2(0.5), 0).r; }\n",
      {{kStorage, kTexture}});
  for (const auto& [mode, expected] :
       {std::pair{VK_SAMPLER_REDUCTION_MODE_MIN, 51}, {VK_SAMPLER_REDUCTION_MODE_MAX, 204}}) {
    const VkSamplerReductionModeCreateInfo reduction{VK_STRUCTURE_TYPE_SAMPLER_REDUCTION_MODE_CREATE_INFO,
                                                     nullptr, mode};
    VkSamplerCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO, info.pNext = &reduction;
    info.magFilter = info.minFilter = VK_FILTER_LINEAR;
    VkSampler sampler = nullptr;
    check(vkCreateSampler(client.device, &info, nullptr, &sampler), "vkCreateSampler");
    client.at_end([&client, sampler] { vkDestroySampler(client.device, sampler, nullptr); });
    const VkDescriptorSet set =
        client.set_with_image(pipeline.set_layout, out, kTexture, {sampler, image.view, kGeneral});
    REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);
    CHECK(int(out.as<float>()[0] * 255 + 0.5f) == expected);
  }
}

TEST_CASE("a view shows slices of an image with three axes as layers") {
  VkPhysicalDeviceImage2DViewOf3DFeaturesEXT slices{};
  slices.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGE_2D_VIEW_OF_3D_FEATURES_EXT;
  slices.image2DViewOf3D = VK_TRUE;
  Client::Options options;
  options.extensions = {"VK_EXT_image_2d_view_of_3d"}, options.more_features = &slices;
  Client client(options);
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO, info.flags = VK_IMAGE_CREATE_2D_VIEW_COMPATIBLE_BIT_EXT;
  info.imageType = VK_IMAGE_TYPE_3D, info.format = VK_FORMAT_R32_UINT, info.extent = {4, 2, 6};
  info.mipLevels = 2, info.arrayLayers = 1, info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  const BoundImage image{client.bound_image(info), nullptr, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 2, 0, 1}};
  const auto view_of = [&](uint32_t level, uint32_t slice) {
    VkImageViewCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, view.image = image.image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D, view.format = VK_FORMAT_R32_UINT;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, level, 1, slice, 1};
    VkImageView out = nullptr;
    const VkResult result = vkCreateImageView(client.device, &view, nullptr, &out);
    if (result == VK_SUCCESS)
      client.at_end([&client, out] { vkDestroyImageView(client.device, out, nullptr); });
    return out;
  };
  const MappedBuffer out = client.buffer(4 * 2 * 6 * 4);
  const ComputePipeline pipeline = client.pipeline(
      "#version 460\nlayout(local_size_x = 1) in;\nlayout(set = 0, binding = 0) buffer O { uint o; };\n"
      "layout(set = 0, binding = 1, r32ui) uniform writeonly uimage2D picture;\n"
      "void main() { uvec2 p = gl_WorkGroupID.xy; imageStore(picture, ivec2(p), uvec4(10 * p.y + p.x + 1)); "
      "}\n",
      {{kStorage, kStorageImage}});
  REQUIRE(client.run([&](VkCommandBuffer commands) {
    const VkClearColorValue zero{};
    vkCmdClearColorImage(commands, image.image, kGeneral, &zero, 1, &image.all);
  }) == VK_SUCCESS);
  for (const auto& [level, slice] : {std::pair{0u, 4u}, {1u, 2u}}) {
    const VkDescriptorSet set = client.set_with_image(pipeline.set_layout, out, kStorageImage,
                                                      {nullptr, view_of(level, slice), kGeneral});
    REQUIRE(client.dispatch(pipeline, set, {4u >> level, 2u >> level, 1}) == VK_SUCCESS);
    const VkBufferImageCopy region{
        0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1}, {}, {4u >> level, 2u >> level, 6u >> level}};
    REQUIRE(client.run([&](VkCommandBuffer commands) {
      vkCmdCopyImageToBuffer(commands, image.image, kGeneral, out.buffer, 1, &region);
    }) == VK_SUCCESS);
    const uint32_t width = 4u >> level, texels = width * (2u >> level);
    for (uint32_t i = 0; i < texels * (6u >> level); ++i) {
      const uint32_t x = i % width, y = i % texels / width;
      CHECK(out.as<uint32_t>()[i] == (i / texels == slice ? 10 * y + x + 1 : 0));
    }
  }
  CHECK(view_of(1, 3) == nullptr);
}

TEST_CASE("an image with blocks is filled by copies and fetched texel by texel", "[portable]") {
  Client client(with_textures());
  const VkExtent3D extent{10, 6, 1};
  const BoundImage image = client.image(VK_FORMAT_BC4_UNORM_BLOCK, extent, 2);
  const MappedBuffer in = client.buffer(4 * 2 * 8), part = client.buffer(8), small = client.buffer(2 * 8);
  // Rows in the buffer have 16 texels, of which the image takes 10.
  fill(in, {10, 20, 30, 99, 40, 50, 60, 99});
  fill(part, {70});
  fill(small, {80, 90});
  REQUIRE(copy_to(client, in, image, {0, 16, 8, kFirstLevel, {0, 0, 0}, extent}) == VK_SUCCESS);
  REQUIRE(copy_to(client, part, image, {0, 0, 0, kFirstLevel, {8, 4, 0}, {2, 2, 1}}) == VK_SUCCESS);
  const VkImageSubresourceLayers second{VK_IMAGE_ASPECT_COLOR_BIT, 1, 0, 1};
  REQUIRE(copy_to(client, small, image, {0, 0, 0, second, {0, 0, 0}, {5, 3, 1}}) == VK_SUCCESS);

  const std::vector<int> texels = fetched(client, image.view, extent);
  for (uint32_t y = 0; y < 6; ++y)
    for (uint32_t x = 0; x < 10; ++x) {
      const int block = int(y / 4 * 3 + x / 4);
      CHECK(texels[y * 10 + x] == (block == 5 ? 70 : 10 + 10 * block));
    }
  const std::vector<int> below = fetched(client, image.view, {5, 3, 1}, 1);
  for (uint32_t i = 0; i < 15; ++i) CHECK(below[i] == (i % 5 < 4 ? 80 : 90));
}

TEST_CASE("blocks are copied between images, also as texels of their size", "[portable]") {
  Client client(with_textures());
  const VkExtent3D extent{12, 8, 1}, in_blocks{3, 2, 1};
  const BoundImage from = client.image(VK_FORMAT_BC4_UNORM_BLOCK, extent),
                   to = client.image(VK_FORMAT_BC1_RGBA_UNORM_BLOCK, extent),
                   words = client.image(VK_FORMAT_R32G32_UINT, in_blocks);
  const MappedBuffer in = client.buffer(6 * 8), out = client.buffer(6 * 8), again = client.buffer(6 * 8);
  fill(in, {1, 2, 3, 4, 5, 6});
  REQUIRE(client.upload(in, from, extent) == VK_SUCCESS);
  const auto copy = [&](const BoundImage& source, const BoundImage& target, VkOffset3D at, VkExtent3D size,
                        VkOffset3D where) {
    return client.run([&](VkCommandBuffer commands) {
      const VkImageCopy region{kFirstLevel, at, kFirstLevel, where, size};
      vkCmdCopyImage(commands, source.image, kGeneral, target.image, kGeneral, 1, &region);
    });
  };

  REQUIRE(copy(from, words, {}, extent, {}) == VK_SUCCESS);
  REQUIRE(client.download(words, out, in_blocks) == VK_SUCCESS);
  REQUIRE(copy(words, to, {}, in_blocks, {}) == VK_SUCCESS);
  REQUIRE(copy(from, to, {8, 4, 0}, {4, 4, 1}, {0, 0, 0}) == VK_SUCCESS);
  REQUIRE(client.download(to, again, extent) == VK_SUCCESS);

  for (uint64_t i = 0; i < 6; ++i) {
    CHECK(out.as<uint64_t>()[i] == i + 1);
    CHECK(again.as<uint64_t>()[i] == (i == 0 ? 6 : i + 1));
  }
}

TEST_CASE("a blit decodes blocks", "[portable][graphics]") {
  Client client(with_textures());
  const VkExtent3D large{8, 4, 1}, small{2, 1, 1};
  const BoundImage from = client.image(VK_FORMAT_BC4_UNORM_BLOCK, large),
                   to = client.image(VK_FORMAT_R8_UNORM, small);
  const MappedBuffer in = client.buffer(2 * 8), out = client.buffer(4);
  fill(in, {100, 200});
  REQUIRE(client.upload(in, from, large) == VK_SUCCESS);
  REQUIRE(client.run([&](VkCommandBuffer commands) {
    const VkImageBlit region{kFirstLevel, {{0, 0, 0}, {8, 4, 1}}, kFirstLevel, {{0, 0, 0}, {2, 1, 1}}};
    vkCmdBlitImage(commands, from.image, kGeneral, to.image, kGeneral, 1, &region, VK_FILTER_LINEAR);
  }) == VK_SUCCESS);
  REQUIRE(client.download(to, out, small) == VK_SUCCESS);
  CHECK(out.as<uint8_t>()[0] == 100);
  CHECK(out.as<uint8_t>()[1] == 200);
}

// Encoders of textures work so: a shader stores blocks as integers, and another one samples them.
TEST_CASE("a shader stores blocks as texels of another view", "[portable]") {
  Client client(with_textures());
  const VkExtent3D extent{10, 4, 1};
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.flags = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_EXTENDED_USAGE_BIT |
               VK_IMAGE_CREATE_BLOCK_TEXEL_VIEW_COMPATIBLE_BIT;
  info.imageType = VK_IMAGE_TYPE_2D, info.format = VK_FORMAT_BC4_UNORM_BLOCK, info.extent = extent;
  info.mipLevels = info.arrayLayers = 1, info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT;
  VkImage image = client.bound_image(info);
  const auto view_as = [&](VkFormat format, VkImageUsageFlags usage) {
    const VkImageViewUsageCreateInfo only{VK_STRUCTURE_TYPE_IMAGE_VIEW_USAGE_CREATE_INFO, nullptr, usage};
    VkImageViewCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, view.pNext = &only;
    view.image = image, view.viewType = VK_IMAGE_VIEW_TYPE_2D, view.format = format;
    view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkImageView out = nullptr;
    check(vkCreateImageView(client.device, &view, nullptr, &out), "vkCreateImageView");
    client.at_end([&client, out] { vkDestroyImageView(client.device, out, nullptr); });
    return out;
  };
  const MappedBuffer unused = client.buffer(4);
  const ComputePipeline pipeline = client.pipeline(
      "#version 460\nlayout(local_size_x = 1) in;\nlayout(set = 0, binding = 0) buffer O { uint o; };\n"
      "layout(set = 0, binding = 1, rg32ui) uniform writeonly uimage2D blocks;\n"
      "void main() { imageStore(blocks, ivec2(gl_WorkGroupID.xy), uvec4(10 * gl_WorkGroupID.x + 5, 0, 0, "
      "0)); "
      "}\n",
      {{kStorage, kStorageImage}});
  const VkDescriptorSet set =
      client.set_with_image(pipeline.set_layout, unused, kStorageImage,
                            {nullptr, view_as(VK_FORMAT_R32G32_UINT, VK_IMAGE_USAGE_STORAGE_BIT), kGeneral});
  REQUIRE(client.dispatch(pipeline, set, {3, 1, 1}) == VK_SUCCESS);

  const std::vector<int> texels =
      fetched(client, view_as(VK_FORMAT_BC4_UNORM_BLOCK, VK_IMAGE_USAGE_SAMPLED_BIT), extent);
  for (uint32_t i = 0; i < 40; ++i) CHECK(texels[i] == int(10 * (i % 10 / 4) + 5));
}

TEST_CASE("copies that cut blocks, clears of them and blits to them are refused") {
  Client client(with_textures());
  const VkExtent3D extent{10, 6, 1};
  const BoundImage image = client.image(VK_FORMAT_BC4_UNORM_BLOCK, extent),
                   plain = client.image(VK_FORMAT_R8_UNORM, extent);
  const MappedBuffer in = client.buffer(256);
  const auto copies = [&](uint32_t row, VkOffset3D at, VkExtent3D size) {
    return copy_to(client, in, image, {0, row, 0, kFirstLevel, at, size}) == VK_SUCCESS;
  };
  CHECK(copies(12, {0, 0, 0}, {8, 4, 1}));
  CHECK_FALSE(copies(0, {2, 0, 0}, {4, 4, 1}));
  CHECK_FALSE(copies(0, {0, 0, 0}, {6, 4, 1}));
  CHECK_FALSE(copies(0, {0, 0, 0}, {8, 2, 1}));
  CHECK_FALSE(copies(10, {0, 0, 0}, {8, 4, 1}));
  CHECK_FALSE(copies(0, {8, 0, 0}, {8, 4, 1}));
  CHECK(client.run([&](VkCommandBuffer commands) {
    const VkClearColorValue zero{};
    vkCmdClearColorImage(commands, image.image, kGeneral, &zero, 1, &image.all);
  }) == VK_ERROR_VALIDATION_FAILED_EXT);
  CHECK(client.run([&](VkCommandBuffer commands) {
    const VkImageBlit region{kFirstLevel, {{0, 0, 0}, {10, 6, 1}}, kFirstLevel, {{0, 0, 0}, {10, 6, 1}}};
    vkCmdBlitImage(commands, plain.image, kGeneral, image.image, kGeneral, 1, &region, VK_FILTER_NEAREST);
  }) == VK_ERROR_VALIDATION_FAILED_EXT);
}

TEST_CASE("all formats BC1 to BC7 are announced for images that are copied, blitted from and sampled") {
  Client client(with_textures());
  for (int format = VK_FORMAT_BC1_RGB_UNORM_BLOCK; format <= VK_FORMAT_BC7_SRGB_BLOCK; ++format) {
    VkFormatProperties can;
    vkGetPhysicalDeviceFormatProperties(client.physical, VkFormat(format), &can);
    CHECK(can.optimalTilingFeatures ==
          (VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT |
           VK_FORMAT_FEATURE_BLIT_SRC_BIT | VK_FORMAT_FEATURE_TRANSFER_SRC_BIT |
           VK_FORMAT_FEATURE_TRANSFER_DST_BIT));
    CHECK(can.bufferFeatures == 0);
    const auto asked = [&](VkImageType type, VkImageUsageFlags usage) {
      VkImageFormatProperties out;
      return vkGetPhysicalDeviceImageFormatProperties(client.physical, VkFormat(format), type,
                                                      VK_IMAGE_TILING_OPTIMAL, usage, 0, &out);
    };
    CHECK(asked(VK_IMAGE_TYPE_2D, VK_IMAGE_USAGE_SAMPLED_BIT) == VK_SUCCESS);
    CHECK(asked(VK_IMAGE_TYPE_3D, VK_IMAGE_USAGE_SAMPLED_BIT) == VK_SUCCESS);
    CHECK(asked(VK_IMAGE_TYPE_1D, VK_IMAGE_USAGE_SAMPLED_BIT) == VK_ERROR_FORMAT_NOT_SUPPORTED);
    CHECK(asked(VK_IMAGE_TYPE_2D, VK_IMAGE_USAGE_STORAGE_BIT) == VK_ERROR_FORMAT_NOT_SUPPORTED);
  }
}

}  // namespace
}  // namespace glint::test::texture_test
