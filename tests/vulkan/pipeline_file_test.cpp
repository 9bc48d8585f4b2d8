// Is the program of pipeline_file_test.py: it runs a shader of a file and writes what the shader wrote to a
// file.
// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/catch.h"
#include "tests/vulkan/client.h"

namespace glint::test {
namespace {

TEST_CASE("a shader of a file runs over one buffer of 4096 bytes", "[.][shader_of_file]") {
  const char* const shader = std::getenv("GLINT_TEST_SHADER");
  const char* const result = std::getenv("GLINT_TEST_RESULT");
  REQUIRE((shader && result));
  std::ifstream text(shader);
  const std::string glsl((std::istreambuf_iterator<char>(text)), {});
  Client client;
  const MappedBuffer out = client.buffer(4096);
  const ComputePipeline pipeline = client.pipeline(glsl, {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}});
  const VkDescriptorSet set = client.set(pipeline.set_layout, {{out.buffer, 0, VK_WHOLE_SIZE}});

  REQUIRE(client.dispatch(pipeline, set, {16, 1, 1}) == VK_SUCCESS);

  std::ofstream(result, std::ios::binary)
      .write(static_cast<const char*>(out.data), std::streamsize(out.bytes));
}

}  // namespace
}  // namespace glint::test
