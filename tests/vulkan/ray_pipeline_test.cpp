// Tests ray-tracing pipelines, libraries, binding tables and launches of rays over the Vulkan loader.
// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <cstring>
#include <iostream>

#include "tests/support/catch.h"
#include "tests/vulkan/ray_pipeline_client.h"

namespace glint::test::ray_pipeline_test {
namespace {

const std::string kHead =
    "#version 460\n#extension GL_EXT_ray_tracing : require\n#extension GL_EXT_ray_query : require\n"
    "layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;\n"
    "layout(set = 0, binding = 1) buffer Found { uint found[]; };\n"
    // A ray query that shaders of every stage may ask: how many triangles lie on a line far away.
    "uint far_away() {\n"
    "  rayQueryEXT q; uint n = 0;\n"
    "  rayQueryInitializeEXT(q, scene, gl_RayFlagsOpaqueEXT, 0xff, vec3(5.4, 0.3, 5), 0, vec3(0, 0, -1), "
    "9);\n"
    "  while (rayQueryProceedEXT(q)) {}\n"
    "  return rayQueryGetIntersectionTypeEXT(q, true) == gl_RayQueryCommittedIntersectionTriangleEXT ? 1 : "
    "0;\n"
    "}\n";

// Eight rays go down beside each other; what they meet adds thousands for each stage that had its say.
const std::vector<RayShader> kSixStages{
    {VK_SHADER_STAGE_RAYGEN_BIT_KHR,
     kHead + "layout(location = 0) rayPayloadEXT uint value;\nvoid main() {\n"
             "  uint i = gl_LaunchIDEXT.x; value = 0;\n"
             "  traceRayEXT(scene, 0, 0xff, 0, 0, 0, vec3(i + 0.4, 0.3, 5), 0, vec3(0, 0, -1), 100, 0);\n"
             "  found[i] = value + 100 * far_away();\n}\n"},
    {VK_SHADER_STAGE_MISS_BIT_KHR,
     kHead +
         "layout(location = 0) rayPayloadInEXT uint value;\nvoid main() { value += 1000 * far_away(); }\n"},
    {VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR,
     kHead +
         "layout(location = 0) rayPayloadInEXT uint value;\nlayout(location = 1) callableDataEXT uint data;\n"
         "void main() { data = gl_InstanceCustomIndexEXT; executeCallableEXT(0, 1);\n"
         "  value += data + 2000 * far_away() + 100000 * gl_IncomingRayFlagsEXT; }\n"},
    {VK_SHADER_STAGE_ANY_HIT_BIT_KHR, kHead + "layout(location = 0) rayPayloadInEXT uint value;\n"
                                              "void main() { value += 4000 * far_away(); if "
                                              "(gl_InstanceCustomIndexEXT == 11) ignoreIntersectionEXT; }\n"},
    {VK_SHADER_STAGE_INTERSECTION_BIT_KHR,
     kHead + "void main() { reportIntersectionEXT(3.0 + float(far_away()), 0u); }\n"},
    {VK_SHADER_STAGE_CALLABLE_BIT_KHR,
     kHead +
         "layout(location = 0) callableDataInEXT uint data;\nvoid main() { data += 8000 * far_away(); }\n"}};
const std::vector<RayGroup> kGroups{
    {0}, {1}, {VK_SHADER_UNUSED_KHR, 2, 3}, {VK_SHADER_UNUSED_KHR, 2, 3, 4}, {5}};
// Squares at 0, 2 and 5, of which the second is ignored, and a box at 3.
const std::vector<uint32_t> kExpected{14110, 1100, 5100, 14120, 1100, 14112, 1100, 1100};

struct Scene {
  RayStructure top;
  MappedBuffer found;
  VkDescriptorSet set;

  explicit Scene(RayPipelineClient& client) {
    const RayStructure square = client.build(client.triangles(unit_square(), false, 0));
    const RayStructure box = client.build(client.boxes({{0, 0, 0, 1, 1, 1}}));
    std::vector<VkAccelerationStructureInstanceKHR> all{
        instance_at(0, 10, square.address), instance_at(2, 11, square.address),
        instance_at(5, 12, square.address), instance_at(3, 20, box.address)};
    all[3].instanceShaderBindingTableRecordOffset = 1;
    top = client.build(client.instances(all));
    found = client.buffer(64);
    set = client.ray_set(client.set_layout, top, {found.buffer});
  }
  std::vector<uint32_t> take() const {
    const auto all = found.as<uint32_t>();
    std::vector<uint32_t> out(all.begin(), all.begin() + 8);
    std::memset(found.data, 0, found.bytes);
    return out;
  }
};

TEST_CASE("all six stages run, and each may ask ray queries", "[portable][rays]") {
  if (!RayClient::is_possible()) return;
  RayPipelineClient client;
  const Scene scene(client);
  const VkPipeline pipeline = client.ray_pipeline({kSixStages, kGroups, {}});
  const RayTable table = client.table(pipeline, 0, {1}, {2, 3}, {4});

  REQUIRE(client.trace(pipeline, scene.set, table, {8, 1, 1}) == VK_SUCCESS);

  CHECK(scene.take() == kExpected);
  CHECK(client.messages.empty());
}

TEST_CASE("a pipeline may skip triangles or boxes, but not for its ray queries", "[portable][rays]") {
  if (!RayClient::is_possible()) return;
  RayPipelineClient client;
  const Scene scene(client);
  const auto traced = [&](VkPipelineCreateFlags flags) {
    const VkPipeline pipeline = client.ray_pipeline({kSixStages, kGroups, {}, flags});
    const RayTable table = client.table(pipeline, 0, {1}, {2, 3}, {4});
    REQUIRE(client.trace(pipeline, scene.set, table, {8, 1, 1}) == VK_SUCCESS);
    return scene.take();
  };

  CHECK(traced(VK_PIPELINE_CREATE_RAY_TRACING_SKIP_TRIANGLES_BIT_KHR) ==
        std::vector<uint32_t>{1100, 1100, 1100, 14120, 1100, 1100, 1100, 1100});
  CHECK(traced(VK_PIPELINE_CREATE_RAY_TRACING_SKIP_AABBS_BIT_KHR) ==
        std::vector<uint32_t>{14110, 1100, 5100, 1100, 1100, 14112, 1100, 1100});
}

// Returns a pipeline whose rays go down beside each other, and what closest-hit shaders say of them.
std::vector<uint32_t> trace_down(RayPipelineClient& client, const Scene& scene, const std::string& raygen,
                                 const std::string& closest) {
  const VkPipeline pipeline = client.ray_pipeline(
      {{{VK_SHADER_STAGE_RAYGEN_BIT_KHR, raygen},
        {VK_SHADER_STAGE_MISS_BIT_KHR,
         kHead + "layout(location = 0) rayPayloadInEXT uint value;\nvoid main() { value = 5; }\n"},
        {VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, closest}},
       {{0}, {1}, {VK_SHADER_UNUSED_KHR, 2}},
       {}});
  const RayTable table = client.table(pipeline, 0, {1}, {2, 2});
  REQUIRE(client.trace(pipeline, scene.set, table, {8, 1, 1}) == VK_SUCCESS);
  return scene.take();
}

TEST_CASE("a closest-hit shader fetches the corners of its triangle", "[rays]") {
  RayPipelineClient client;
  const Scene scene(client);
  const std::string head = "#version 460\n#extension GL_EXT_ray_tracing_position_fetch : require\n" +
                           kHead.substr(kHead.find('\n') + 1);

  const auto found = trace_down(
      client, scene, kSixStages[0].glsl,
      head +
          "layout(location = 0) rayPayloadInEXT uint value;\nvoid main() {\n"
          "  vec3 sum = gl_HitTriangleVertexPositionsEXT[0] + gl_HitTriangleVertexPositionsEXT[1] +\n"
          "             2.0 * gl_HitTriangleVertexPositionsEXT[2];\n"
          "  value = uint(sum.x) + 10 * uint(sum.y);\n}\n");

  CHECK(found == std::vector<uint32_t>{121, 105, 121, 105, 105, 121, 105, 105});
}

// Old compilers wrote so, and GPUs take it.
TEST_CASE("weights of a triangle reach a shader whose attributes have a third float", "[portable][rays]") {
  if (!RayClient::is_possible()) return;
  RayPipelineClient client;
  const Scene scene(client);
  std::vector<RayShader> shaders = kSixStages;
  shaders[2].glsl = kHead +
                    "layout(location = 0) rayPayloadInEXT uint value;\nhitAttributeEXT vec3 weights;\n"
                    "void main() { value = uint(round(100 * (weights.x + weights.y))); }\n";
  const VkPipeline pipeline = client.ray_pipeline({shaders, kGroups, {}});
  const RayTable table = client.table(pipeline, 0, {1}, {2, 3}, {4});
  REQUIRE(client.trace(pipeline, scene.set, table, {8, 1, 1}) == VK_SUCCESS);
  CHECK(scene.take()[0] % 100 == 70);  // The ray meets the first square at (0.4, 0.3).
}

TEST_CASE("a ray generation shader keeps hit objects, reorders by them and runs their shaders",
          "[rays][reordering]") {
  RayPipelineClient client;
  const Scene scene(client);
  VkPhysicalDeviceRayTracingInvocationReorderPropertiesNV hint{};
  hint.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_INVOCATION_REORDER_PROPERTIES_NV;
  VkPhysicalDeviceProperties2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &hint, {}};
  vkGetPhysicalDeviceProperties2(client.physical, &all);
  const char* const keys = std::getenv("GLINT_SET");
  const bool sorts = keys && std::string(keys).find("core.reorder=sort") != std::string::npos;
  CHECK(hint.rayTracingInvocationReorderReorderingHint ==
        (sorts ? VK_RAY_TRACING_INVOCATION_REORDER_MODE_REORDER_NV
               : VK_RAY_TRACING_INVOCATION_REORDER_MODE_NONE_NV));
  const std::string head = "#version 460\n#extension GL_NV_shader_invocation_reorder : require\n" +
                           kHead.substr(kHead.find('\n') + 1);

  const auto found = trace_down(client, scene,
                                head +
                                    "layout(location = 0) rayPayloadEXT uint value;\nvoid main() {\n"
                                    "  uint i = gl_LaunchIDEXT.x; value = 0; hitObjectNV hit;\n"
                                    "  hitObjectTraceRayNV(hit, scene, 0, 0xff, 0, 0, 0, vec3(i + 0.4, 0.3, "
                                    "5), 0, vec3(0, 0, -1), 100, 0);\n"
                                    "  reorderThreadNV(hit);\n  hitObjectExecuteShaderNV(hit, 0);\n"
                                    "  found[i] = value + (hitObjectIsHitNV(hit) ? 1000 : 0);\n}\n",
                                kHead +
                                    "layout(location = 0) rayPayloadInEXT uint value;\nvoid main() { value = "
                                    "gl_InstanceCustomIndexEXT; }\n");

  CHECK(found == std::vector<uint32_t>{1010, 5, 1011, 5, 5, 1012, 5, 5});
}

TEST_CASE("libraries bring their groups into a pipeline", "[portable][rays]") {
  if (!RayClient::is_possible()) return;
  RayPipelineClient client;
  const Scene scene(client);
  const VkPipelineCreateFlags library = VK_PIPELINE_CREATE_LIBRARY_BIT_KHR;
  const VkPipeline hits =
      client.ray_pipeline({{kSixStages[2], kSixStages[3], kSixStages[4]},
                           {{VK_SHADER_UNUSED_KHR, 0, 1}, {VK_SHADER_UNUSED_KHR, 0, 1, 2}},
                           {},
                           library});
  const VkPipeline others = client.ray_pipeline({{kSixStages[1], kSixStages[5]}, {{0}, {1}}, {}, library});
  const VkPipeline pipeline = client.ray_pipeline({{kSixStages[0]}, {{0}}, {hits, others}});
  const RayTable table = client.table(pipeline, 0, {3}, {1, 2}, {4});

  REQUIRE(client.trace(pipeline, scene.set, table, {8, 1, 1}) == VK_SUCCESS);

  CHECK(scene.take() == kExpected);
}

TEST_CASE("groups of a pipeline may be made of the stages of its libraries", "[rays]") {
  if (!RayClient::is_possible()) return;
  RayPipelineClient client;
  const Scene scene(client);
  const VkPipelineCreateFlags library = VK_PIPELINE_CREATE_LIBRARY_BIT_KHR;
  const VkPipeline hits =
      client.ray_pipeline({{kSixStages[2], kSixStages[3], kSixStages[4]}, {}, {}, library});
  const VkPipeline others = client.ray_pipeline({{kSixStages[1], kSixStages[5]}, {{1}}, {}, library});
  constexpr uint32_t kNone = VK_SHADER_UNUSED_KHR;
  const VkPipeline pipeline =
      client.ray_pipeline({{kSixStages[0]}, {{0}, {4}, {kNone, 1, 2}, {kNone, 1, 2, 3}}, {hits, others}});
  // The group of a library follows those of the pipeline.
  const RayTable table = client.table(pipeline, 0, {1}, {2, 3}, {4});

  REQUIRE(client.trace(pipeline, scene.set, table, {8, 1, 1}) == VK_SUCCESS);

  CHECK(scene.take() == kExpected);
}

TEST_CASE("indirect launches read their size, or their whole table, from memory", "[portable][rays]") {
  if (!RayClient::is_possible()) return;
  RayPipelineClient client;
  const Scene scene(client);
  const VkPipeline pipeline = client.ray_pipeline({kSixStages, kGroups, {}});
  const RayTable t = client.table(pipeline, 0, {1}, {2, 3}, {4});
  const MappedBuffer size = client.buffer_with_address(256);
  auto expected = kExpected;
  expected[6] = expected[7] = 0;
  const VkTraceRaysIndirectCommandKHR six{6, 1, 1};
  std::memcpy(size.data, &six, sizeof six);
  scene.take();

  REQUIRE(client.run([&](VkCommandBuffer commands) {
    client.bind(commands, pipeline, scene.set);
    client.cmd_trace_indirect(commands, &t.raygen, &t.miss, &t.hit, &t.callable, client.address(size));
  }) == VK_SUCCESS);
  CHECK(scene.take() == expected);

  const VkTraceRaysIndirectCommand2KHR whole{t.raygen.deviceAddress,
                                             t.raygen.size,
                                             t.miss.deviceAddress,
                                             t.miss.size,
                                             t.miss.stride,
                                             t.hit.deviceAddress,
                                             t.hit.size,
                                             t.hit.stride,
                                             t.callable.deviceAddress,
                                             t.callable.size,
                                             t.callable.stride,
                                             6,
                                             1,
                                             1};
  std::memcpy(size.data, &whole, sizeof whole);
  REQUIRE(client.run([&](VkCommandBuffer commands) {
    client.bind(commands, pipeline, scene.set);
    client.cmd_trace_indirect2(commands, client.address(size));
  }) == VK_SUCCESS);
  CHECK(scene.take() == expected);
}

TEST_CASE("a stack of the size that the groups ask for is enough", "[portable][rays]") {
  if (!RayClient::is_possible()) return;
  RayPipelineClient client;
  const Scene scene(client);
  RayPipelineOrder order{kSixStages, kGroups, {}};
  order.has_dynamic_stack = true;
  const VkPipeline pipeline = client.ray_pipeline(order);
  const RayTable t = client.table(pipeline, 0, {1}, {2, 3}, {4});
  const auto bytes = [&](uint32_t group, VkShaderGroupShaderKHR which) {
    return uint32_t(client.stack_size(client.device, pipeline, group, which));
  };
  const uint32_t all =
      bytes(0, VK_SHADER_GROUP_SHADER_GENERAL_KHR) + bytes(1, VK_SHADER_GROUP_SHADER_GENERAL_KHR) +
      bytes(3, VK_SHADER_GROUP_SHADER_CLOSEST_HIT_KHR) + bytes(3, VK_SHADER_GROUP_SHADER_ANY_HIT_KHR) +
      bytes(3, VK_SHADER_GROUP_SHADER_INTERSECTION_KHR) + bytes(4, VK_SHADER_GROUP_SHADER_GENERAL_KHR);

  REQUIRE(client.run([&](VkCommandBuffer commands) {
    client.bind(commands, pipeline, scene.set);
    client.cmd_set_stack(commands, all);
    client.cmd_trace(commands, &t.raygen, &t.miss, &t.hit, &t.callable, 8, 1, 1);
  }) == VK_SUCCESS);

  CHECK(scene.take() == kExpected);
}

// Applications declare one level, nest two, and run on drivers of hardware.
TEST_CASE("traces that are nested deeper than a pipeline says run, which is said once", "[rays]") {
  RayPipelineClient client;
  const Scene scene(client);
  RayPipelineOrder order{kSixStages, kGroups, {}};
  order.depth = 1;
  order.shaders[2].glsl =
      kHead +
      "layout(location = 0) rayPayloadInEXT uint value;\nvoid main() {\n"
      "  uint mine = gl_InstanceCustomIndexEXT;\n  if (mine == 12) return;\n"
      "  traceRayEXT(scene, 0, 0xff, 0, 0, 0, vec3(5.4, 0.3, 5), 0, vec3(0, 0, -1), 100, 0);\n"
      "  value = mine;\n}\n";
  const VkPipeline pipeline = client.ray_pipeline(order);
  const RayTable table = client.table(pipeline, 0, {1}, {2, 3}, {4});

  REQUIRE(client.trace(pipeline, scene.set, table, {8, 1, 1}) == VK_SUCCESS);
  REQUIRE(client.trace(pipeline, scene.set, table, {8, 1, 1}) == VK_SUCCESS);

  CHECK(scene.take()[0] == 110);
  REQUIRE(client.messages.size() == 1);
  CHECK_THAT(client.messages[0], Catch::Contains("maxPipelineRayRecursionDepth is 1"));
}

TEST_CASE("handles of another pipeline are faults that are said, and not traced", "[rays]") {
  RayPipelineClient client;
  const Scene scene(client);
  const VkPipeline other = client.ray_pipeline({kSixStages, kGroups, {}});
  const VkPipeline pipeline = client.ray_pipeline({kSixStages, kGroups, {}});
  const RayTable stale = client.table(other, 0, {1}, {2, 3}, {4});
  RayTable mixed = client.table(pipeline, 0, {1}, {2, 3}, {4});
  mixed.hit = stale.hit;
  scene.take();

  REQUIRE(client.trace(pipeline, scene.set, stale, {8, 1, 1}) == VK_SUCCESS);
  CHECK(scene.take() == std::vector<uint32_t>(8, 0));
  REQUIRE(client.messages.size() == 1);
  CHECK_THAT(client.messages[0], Catch::Contains("holds no ray generation group of the pipeline"));
  REQUIRE(client.trace(pipeline, scene.set, mixed, {8, 1, 1}) == VK_SUCCESS);
  CHECK(scene.take()[1] == 1100);
  REQUIRE(client.messages.size() == 2);
  CHECK_THAT(client.messages[1], Catch::Contains("whose handle is no hit group of this pipeline"));
}

TEST_CASE("a table that leaves its buffer, and groups that do not exist, are said", "[rays]") {
  RayPipelineClient client;
  const Scene scene(client);
  const VkPipeline pipeline = client.ray_pipeline({kSixStages, kGroups, {}});
  RayTable table = client.table(pipeline, 0, {1}, {2, 3}, {4});
  table.hit.size = table.miss.size = ~VkDeviceSize{0};
  table.callable.deviceAddress = 0x1234'0000'0000;

  REQUIRE(client.trace(pipeline, scene.set, table, {8, 1, 1}) == VK_SUCCESS);
  CHECK(scene.take()[0] == 14110 - 8000);  // The callable shader is missing.
  CHECK(client.messages.size() == 1);
  CHECK_THROWS(client.ray_pipeline({{kSixStages[0]}, {{7}}, {}}));
  CHECK_THROWS(client.ray_pipeline({{kSixStages[0]}, {{VK_SHADER_UNUSED_KHR, 0}}, {}}));
}

// Is a program of timing_test.py: a trace, a dispatch and a trace again.
TEST_CASE("traces say what the timing machine took for them", "[.][traces]") {
  RayPipelineClient client;
  const Scene scene(client);
  const VkPipeline pipeline = client.ray_pipeline({kSixStages, kGroups, {}});
  const RayTable table = client.table(pipeline, 0, {1}, {2, 3}, {4});
  const ComputePipeline nothing =
      client.pipeline("#version 460\nlayout(local_size_x = 64) in;\nvoid main() {}\n", {{}});

  REQUIRE(client.trace(pipeline, scene.set, table, {8, 1, 1}) == VK_SUCCESS);
  CHECK(scene.take() == kExpected);
  REQUIRE(client.dispatch(nothing, nullptr, {1, 1, 1}) == VK_SUCCESS);
  REQUIRE(client.trace(pipeline, scene.set, table, {8, 1, 1}) == VK_SUCCESS);
  CHECK(scene.take() == kExpected);
  std::cout << client.prints;
}

}  // namespace
}  // namespace glint::test::ray_pipeline_test
