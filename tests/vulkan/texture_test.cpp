// Tests textures over the Vulkan loader: anisotropic samplers.
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.h"
#include "tests/vulkan/client.h"

namespace glint::test::texture_test {
namespace {

constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkDescriptorType kTexture = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
constexpr VkImageLayout kGeneral = VK_IMAGE_LAYOUT_GENERAL;

Client::Options with_textures() {
  Client::Options options;
  options.features.samplerAnisotropy = VK_TRUE;
  return options;
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

}  // namespace
}  // namespace glint::test::texture_test
