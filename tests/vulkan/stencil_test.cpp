// Tests the aspects of images with depth and stencil: clears, copies, blits, samples, and the clears of
// passes.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "tests/support/catch.h"
#include "tests/vulkan/client.h"

namespace glint::test::stencil_test {
namespace {

constexpr VkExtent3D kSize{5, 3, 1};
constexpr uint32_t kTexels = 15;
constexpr VkImageAspectFlags kDepth = VK_IMAGE_ASPECT_DEPTH_BIT, kStencil = VK_IMAGE_ASPECT_STENCIL_BIT;

VkImage image_of(Client& client, VkFormat format) {
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO, info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format, info.extent = kSize, info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  return client.bound_image(info);
}

VkImageView view_of(Client& client, VkImage image, VkFormat format, VkImageAspectFlags aspects) {
  VkImageViewCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, info.image = image, info.format = format;
  info.viewType = VK_IMAGE_VIEW_TYPE_2D, info.subresourceRange = {aspects, 0, 1, 0, 1};
  VkImageView out = nullptr;
  check(vkCreateImageView(client.device, &info, nullptr, &out), "vkCreateImageView");
  client.at_end([device = client.device, out] { vkDestroyImageView(device, out, nullptr); });
  return out;
}

VkBufferImageCopy region_of(VkImageAspectFlags aspect) {
  VkBufferImageCopy out{};
  out.imageSubresource = {aspect, 0, 0, 1}, out.imageExtent = kSize;
  return out;
}

void barrier(VkCommandBuffer commands) {
  const VkMemoryBarrier all{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_MEMORY_WRITE_BIT,
                            VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1,
                       &all, 0, nullptr, 0, nullptr);
}

void clear(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspects, float depth,
           uint32_t stencil) {
  const VkClearDepthStencilValue value{depth, stencil};
  const VkImageSubresourceRange range{aspects, 0, 1, 0, 1};
  vkCmdClearDepthStencilImage(commands, image, VK_IMAGE_LAYOUT_GENERAL, &value, 1, &range);
  barrier(commands);
}

void download(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect, const MappedBuffer& to) {
  const VkBufferImageCopy region = region_of(aspect);
  vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_GENERAL, to.buffer, 1, &region);
  barrier(commands);
}

// Returns what a word of depth is in a buffer.
uint32_t depth_word(VkFormat format, float depth) {
  return format == VK_FORMAT_D24_UNORM_S8_UINT ? uint32_t(double(depth) * 0xff'ffff + 0.5)
                                               : std::bit_cast<uint32_t>(depth);
}

const VkFormat kFormats[] = {VK_FORMAT_D32_SFLOAT_S8_UINT, VK_FORMAT_D24_UNORM_S8_UINT};

TEST_CASE("depth and stencil are cleared and copied to buffers each on its own") {
  Client client;
  for (const VkFormat format : kFormats) {
    const MappedBuffer depth = client.buffer(256), stencil = client.buffer(256);
    std::memset(depth.data, 0x77, 256), std::memset(stencil.data, 0x77, 256);
    const VkImage image = image_of(client, format);

    REQUIRE(client.run([&](VkCommandBuffer commands) {
      clear(commands, image, kDepth | kStencil, 0.25f, 7);
      clear(commands, image, kStencil, 0.75f, 200);
      download(commands, image, kDepth, depth), download(commands, image, kStencil, stencil);
    }) == VK_SUCCESS);

    for (uint32_t i = 0; i < kTexels; ++i) {
      REQUIRE(depth.as<uint32_t>()[i] == depth_word(format, 0.25f));
      REQUIRE(stencil.as<uint8_t>()[i] == 200);
    }
    CHECK(depth.as<uint32_t>()[kTexels] == 0x7777'7777);
    CHECK(stencil.as<uint8_t>()[kTexels] == 0x77);
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(client.device, image, &needs);
    CHECK(needs.size == 128);  // 60 bytes of depth, and 15 of stencil behind them
  }
  CHECK(client.messages.empty());
}

TEST_CASE("depth of 24 bits without stencil is cleared, copied out and in, and may be an attachment") {
  Client client;
  const VkFormat format = VK_FORMAT_X8_D24_UNORM_PACK32;
  VkFormatProperties features{};
  vkGetPhysicalDeviceFormatProperties(client.physical, format, &features);
  CHECK(features.optimalTilingFeatures & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT);
  const MappedBuffer first = client.buffer(256), second = client.buffer(256);
  const VkImage image = image_of(client, format);

  REQUIRE(client.run([&](VkCommandBuffer commands) {
    clear(commands, image, kDepth, 0.7f, 0);
    download(commands, image, kDepth, first);
    const VkBufferImageCopy region = region_of(kDepth);
    vkCmdCopyBufferToImage(commands, first.buffer, image, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
    barrier(commands);
    download(commands, image, kDepth, second);
  }) == VK_SUCCESS);

  for (uint32_t i = 0; i < kTexels; ++i) {
    REQUIRE(first.as<uint32_t>()[i] == uint32_t(0.7f * 0xff'ffff + 0.5));
    REQUIRE(second.as<uint32_t>()[i] == first.as<uint32_t>()[i]);
  }
  CHECK(client.messages.empty());
}

TEST_CASE("both aspects are uploaded, copied and blitted between images, and sampled") {
  Client client;
  for (const VkFormat format : kFormats) {
    const MappedBuffer depth = client.buffer(256), stencil = client.buffer(256), out = client.buffer(256);
    for (uint32_t i = 0; i < kTexels; ++i) {
      depth.as<uint32_t>()[i] = format == VK_FORMAT_D24_UNORM_S8_UINT
                                    ? 0xff00'0000 | (1'000'003 * (i + 1))
                                    : std::bit_cast<uint32_t>(float(i) / 16);
      stencil.as<uint8_t>()[i] = uint8_t(16 * i + 3);
    }
    const VkImage first = image_of(client, format), second = image_of(client, format),
                  third = image_of(client, format);
    const MappedBuffer depth_back = client.buffer(256), stencil_back = client.buffer(256);
    REQUIRE(client.run([&](VkCommandBuffer commands) {
      for (const VkImageAspectFlags aspect : {kDepth, kStencil}) {
        const VkBufferImageCopy region = region_of(aspect);
        vkCmdCopyBufferToImage(commands, (aspect == kDepth ? depth : stencil).buffer, first,
                               VK_IMAGE_LAYOUT_GENERAL, 1, &region);
      }
      barrier(commands);
      const VkImageSubresourceLayers both{kDepth | kStencil, 0, 0, 1};
      const VkImageCopy copied{both, {}, both, {}, kSize};
      vkCmdCopyImage(commands, first, VK_IMAGE_LAYOUT_GENERAL, second, VK_IMAGE_LAYOUT_GENERAL, 1, &copied);
      barrier(commands);
      const VkOffset3D end{int32_t(kSize.width), int32_t(kSize.height), 1};
      const VkImageBlit mirrored{both, {{}, end}, both, {{end.x, 0, 0}, {0, end.y, 1}}};
      vkCmdBlitImage(commands, second, VK_IMAGE_LAYOUT_GENERAL, third, VK_IMAGE_LAYOUT_GENERAL, 1, &mirrored,
                     VK_FILTER_NEAREST);
      barrier(commands);
      download(commands, third, kDepth, depth_back), download(commands, third, kStencil, stencil_back);
    }) == VK_SUCCESS);
    const auto mirror = [](uint32_t i) { return i / kSize.width * kSize.width + 4 - i % kSize.width; };
    const uint32_t mask = format == VK_FORMAT_D24_UNORM_S8_UINT ? 0xff'ffff : 0xffff'ffff;
    for (uint32_t i = 0; i < kTexels; ++i) {
      REQUIRE(depth_back.as<uint32_t>()[i] == (depth.as<uint32_t>()[mirror(i)] & mask));
      REQUIRE(stencil_back.as<uint8_t>()[i] == stencil.as<uint8_t>()[mirror(i)]);
    }

    for (const VkImageAspectFlags aspect : {kDepth, kStencil}) {
      const ComputePipeline pipeline = client.pipeline(
          "#version 460\nlayout(local_size_x = 5, local_size_y = 3) in;\n"
          "layout(set = 0, binding = 0) buffer Out { uint v[]; };\n"
          "layout(set = 0, binding = 1) uniform " +
              std::string(aspect == kDepth ? "sampler2D" : "usampler2D") +
              " picture;\n"
              "void main() { v[gl_LocalInvocationIndex] = " +
              (aspect == kDepth ? "floatBitsToUint" : "uint") +
              "(texelFetch(picture, ivec2(gl_LocalInvocationID.xy), 0).x); }\n",
          {.bindings = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}});
      const VkDescriptorImageInfo shown{
          client.sampler(VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE),
          view_of(client, second, format, aspect), VK_IMAGE_LAYOUT_GENERAL};
      const VkDescriptorSet set =
          client.set_with_image(pipeline.set_layout, out, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, shown);
      REQUIRE(client.dispatch(pipeline, set, {1, 1, 1}) == VK_SUCCESS);
      for (uint32_t i = 0; i < kTexels; ++i) {
        const uint32_t word = depth.as<uint32_t>()[i] & mask;
        const uint32_t wanted = aspect == kStencil ? stencil.as<uint8_t>()[i]
                                : format == VK_FORMAT_D24_UNORM_S8_UINT
                                    ? std::bit_cast<uint32_t>(float(double(word) / 0xff'ffff))
                                    : word;
        REQUIRE(out.as<uint32_t>()[i] == wanted);
      }
    }
  }
  CHECK(client.messages.empty());
}

TEST_CASE("passes clear the aspects that they say") {
  VkPhysicalDeviceDynamicRenderingFeatures rendering{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DYNAMIC_RENDERING_FEATURES, nullptr, VK_TRUE};
  Client::Options options;
  options.more_features = &rendering;
  Client client(options);
  const VkFormat format = VK_FORMAT_D32_SFLOAT_S8_UINT;
  const MappedBuffer depth = client.buffer(256), stencil = client.buffer(256), alone = client.buffer(256);
  const VkImage image = image_of(client, format), only_stencil = image_of(client, VK_FORMAT_S8_UINT);
  const VkRect2D area{{0, 0}, {4, 3}};
  const auto attachment = [&](VkImageView view, VkAttachmentLoadOp load, uint32_t value) {
    VkRenderingAttachmentInfo out{};
    out.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO, out.imageView = view, out.loadOp = load;
    out.clearValue.depthStencil = {0.5f, value};
    return out;
  };
  const VkImageView both = view_of(client, image, format, kDepth | kStencil),
                    one = view_of(client, only_stencil, VK_FORMAT_S8_UINT, kStencil);
  const auto kept = attachment(both, VK_ATTACHMENT_LOAD_OP_LOAD, 1),
             cleared = attachment(both, VK_ATTACHMENT_LOAD_OP_CLEAR, 9),
             cleared_alone = attachment(one, VK_ATTACHMENT_LOAD_OP_CLEAR, 77);
  VkRenderingInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO, info.renderArea = area, info.layerCount = 1;
  info.pDepthAttachment = &kept, info.pStencilAttachment = &cleared;

  REQUIRE(client.run([&](VkCommandBuffer commands) {
    clear(commands, image, kDepth | kStencil, 0.25f, 3);
    clear(commands, only_stencil, kStencil, 0.25f, 4);
    vkCmdBeginRendering(commands, &info);
    const VkClearAttachment again{kStencil, 0, {.depthStencil = {1.0f, 10}}};
    const VkClearRect corner{{{0, 0}, {1, 1}}, 0, 1};
    vkCmdClearAttachments(commands, 1, &again, 1, &corner);
    vkCmdEndRendering(commands);
    info.pDepthAttachment = nullptr, info.pStencilAttachment = &cleared_alone;
    vkCmdBeginRendering(commands, &info);
    vkCmdEndRendering(commands);
    barrier(commands);
    download(commands, image, kDepth, depth), download(commands, image, kStencil, stencil);
    download(commands, only_stencil, kStencil, alone);
  }) == VK_SUCCESS);

  for (uint32_t i = 0; i < kTexels; ++i) {
    CAPTURE(i);
    const bool is_inside = i % kSize.width < 4;
    REQUIRE(depth.as<float>()[i] == 0.25f);
    REQUIRE(stencil.as<uint8_t>()[i] == (i == 0 ? 10 : is_inside ? 9 : 3));
    REQUIRE(alone.as<uint8_t>()[i] == (is_inside ? 77 : 4));
  }
  CHECK(client.messages.empty());
}

TEST_CASE("a copy between different aspects is refused") {
  Client client;
  const VkImage from = image_of(client, VK_FORMAT_D32_SFLOAT_S8_UINT),
                to = image_of(client, VK_FORMAT_D32_SFLOAT_S8_UINT);
  const VkImageCopy region{{kDepth, 0, 0, 1}, {}, {kStencil, 0, 0, 1}, {}, kSize};
  VkCommandBuffer commands = nullptr;

  CHECK(client.record(commands, [&](VkCommandBuffer into) {
    vkCmdCopyImage(into, from, VK_IMAGE_LAYOUT_GENERAL, to, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
  }) == VK_ERROR_VALIDATION_FAILED_EXT);

  REQUIRE(client.messages.size() == 1);
  CHECK(client.messages[0].find("the aspects of a copy are not those of both images") != std::string::npos);
}

}  // namespace
}  // namespace glint::test::stencil_test
