// Tests that the driver stands bad weather: many lives in one process, unloading, and too little memory.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/catch.h"
#include "tests/vulkan/client.h"

namespace glint::test {
namespace {

const char* const kCount =
    "#version 460\nlayout(local_size_x = 64) in;\n"
    "layout(set = 0, binding = 0) buffer A { uint a[]; };\n"
    "void main() { a[gl_GlobalInvocationID.x] += 1; }\n";

auto num_open_files() {
  return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
}

void live_once() {
  Client client;
  const MappedBuffer out = client.buffer(4096);
  std::memset(out.data, 0, out.bytes);
  const ComputePipeline pipeline = client.pipeline(kCount, {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}});
  const VkDescriptorSet set = client.set(pipeline.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});
  REQUIRE(client.dispatch(pipeline, set, {16, 1, 1}) == VK_SUCCESS);
  const auto words = out.as<uint32_t>();
  REQUIRE(std::all_of(words.begin(), words.end(), [](uint32_t word) { return word == 1; }));
  REQUIRE(client.messages.empty());
}

// Returns the driver's library as its manifest names it.
std::string library_of_manifest() {
  const char* const manifest = std::getenv("VK_DRIVER_FILES");
  REQUIRE(manifest);
  std::ifstream in(manifest);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  const size_t name = text.find('"', text.find(':', text.find("library_path"))) + 1;
  return text.substr(name, text.find('"', name) - name);
}

TEST_CASE("a hundred instances with devices and launches leave no file open") {
  live_once();
  const auto before = num_open_files();

  for (int i = 0; i < 100; ++i) live_once();

  CHECK(num_open_files() == before);
}

TEST_CASE("the driver can be loaded and unloaded a hundred times") {
  const std::string library = library_of_manifest();
  for (int i = 0; i < 100; ++i) {
    void* const driver = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    REQUIRE(driver);
    using Negotiate = VkResult (*)(uint32_t*);
    const auto negotiate =
        reinterpret_cast<Negotiate>(dlsym(driver, "vk_icdNegotiateLoaderICDInterfaceVersion"));
    REQUIRE(negotiate);
    uint32_t version = 5;
    REQUIRE(negotiate(&version) == VK_SUCCESS);
    REQUIRE(dlclose(driver) == 0);
  }
  live_once();
}

TEST_CASE("memory that the host does not have is refused, and the rest stays usable", "[.][little_memory]") {
  Client client;
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, VkDeviceSize{4} << 30, 0};
  VkDeviceMemory memory = nullptr;

  CHECK(vkAllocateMemory(client.device, &info, nullptr, &memory) == VK_ERROR_OUT_OF_DEVICE_MEMORY);

  info.allocationSize = 1 << 20;
  CHECK(vkAllocateMemory(client.device, &info, nullptr, &memory) == VK_SUCCESS);
  vkFreeMemory(client.device, memory, nullptr);
}

}  // namespace
}  // namespace glint::test
