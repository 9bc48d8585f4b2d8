// Tests binding tables that a program has put into memory: strides, handles, and handles of nothing.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/device_table.h"

#include <cstring>
#include <string>
#include <vector>

#include "pipeline/functional_machine.h"
#include "pipeline/launch_builder.h"
#include "tests/support/catch.h"

namespace glint::pipeline::device_table_test {
namespace {

using Catch::Contains;

constexpr uint64_t kPipeline = 42;

constexpr const char* kRaygen = R"(#version 460
#extension GL_EXT_ray_tracing : require
layout(binding = 0) buffer Out { uint result[]; };
layout(binding = 1) uniform accelerationStructureEXT scene;
layout(push_constant) uniform Constants { float x; uint index, calls; };
layout(location = 0) rayPayloadEXT uint traced;
layout(location = 1) callableDataEXT uint called;
void main() {
  traced = called = 0;
  if (calls != 0)
    executeCallableEXT(index, 1);
  else
    traceRayEXT(scene, 0, 0xff, index, 0, index, vec3(x, 0.25, 5), 0, vec3(0, 0, -1), 100, 0);
  result[0] = traced + called;
}
)";
// Each of the other shaders adds the word of its record to a number of its own.
std::string other(const std::string& payload, int number) {
  return "#version 460\n#extension GL_EXT_ray_tracing : require\n"
         "layout(shaderRecordEXT, std430) buffer Record { uint word; };\nlayout(location = 0) " +
         payload + " uint v;\nvoid main() { v = " + std::to_string(number) + " + word; }\n";
}

// Holds a pipeline of four groups and a table of two records in each region but the first one.
struct Host {
  GpuParams gpu;
  std::vector<CompiledStage> stages{compile(kRaygen, isa::Stage::RayGeneration),
                                    compile(other("rayPayloadInEXT", 100), isa::Stage::Miss),
                                    compile(other("rayPayloadInEXT", 200), isa::Stage::ClosestHit),
                                    compile(other("callableDataInEXT", 300), isa::Stage::Callable)};
  LinkedShaders shaders{{stages[0].program, stages[1].program, stages[2].program, stages[3].program},
                        stages[0].reflection.bindings,
                        gpu,
                        nullptr};
  std::vector<ShaderGroup> groups = std::vector<ShaderGroup>(4);
  mem::AddressSpace memory;
  std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0};
  Address out = memory.allocate("out", 64), records = memory.allocate("records", 4096), top = build();
  // The stride of each region differs; a word follows each handle.
  DeviceTable table{
      {records, 32, 32}, {records + 64, 64, 128}, {records + 1024, 96, 32 + 96}, {records + 2048, 32, 64}};

  Host() {
    groups[0].general = 0, groups[1].general = 1, groups[3].general = 3;
    groups[2].hit.closest_hit = 2;
    put(table.raygen, 0, group_handle(kPipeline, 0));
    for (uint32_t i = 0; i < 2; ++i) {
      put(table.miss, i, group_handle(kPipeline, 1), 10 + i);
      put(table.hit, i, group_handle(kPipeline, 2), 20 + i);
    }
    put(table.callable, 0, group_handle(kPipeline, 3));
  }
  static CompiledStage compile(const std::string& text, isa::Stage stage) {
    Diagnostics notes;
    return compile_stage(frontend::glsl_text_to_spirv(text, "shader", stage, {}), {"shader", "", {}}, {},
                         notes, nullptr);
  }
  Address build() {
    rt::Geometry geometry;
    geometry.positions = std::as_bytes(std::span(corners));
    const rt::StructureInfo bottom = rt::build_bottom(memory, "bottom", {{geometry}});
    return rt::build_top(memory, "top", std::vector<rt::Instance>(1), std::vector{bottom}).address;
  }
  void put(const DeviceRegion& region, uint64_t record, const GroupHandle& handle, uint32_t word = 0) {
    memory.write(region.base + record * region.stride, handle.data(), handle.size());
    if (word) memory.write(region.base + record * region.stride + handle.size(), &word, 4);
  }

  // Returns what the ray generation shader stores, or the message of a fault.
  std::string run(float x, uint32_t index, bool calls) {
    struct {
      float x;
      uint32_t index, calls;
    } const constants{x, index, calls};
    LaunchBuilder builder(shaders, memory);
    builder.bind_buffers({0, 0}, {{out, 64}});
    builder.bind_buffers({0, 1}, {{top, 0}});
    builder.set_push_constants(std::as_bytes(std::span(&constants, 1)));
    builder.set_rays({1, 1, 1}, 1, 1);
    read_binding_table(builder.world, memory, table, groups, kPipeline);
    try {
      run_functional(builder.finish(16), 10000, {});
    } catch (const Error& error) {
      return error.what();
    }
    return std::to_string(memory.view<uint32_t>(out, 1)[0]);
  }
};

TEST_CASE("records that lie in memory call the groups of their handles, and have their data") {
  Host host;
  CHECK(host.run(0.25f, 0, false) == "220");
  CHECK(host.run(0.25f, 1, false) == "221");
  CHECK(host.run(9, 0, false) == "110");
  CHECK(host.run(9, 1, false) == "111");
  CHECK(host.run(0, 0, true) == "300");
  host.table.miss.stride = 0;  // Every index means the first record.
  CHECK(host.run(9, 1, false) == "110");
}

TEST_CASE("a record of zeros calls nothing") {
  Host host;
  host.put(host.table.hit, 1, {});
  CHECK(host.run(0.25f, 1, false) == "0");
  CHECK(host.run(0, 1, true) == "0");
}

TEST_CASE("the use of a handle that is no group of the pipeline is a fault, and its presence is none") {
  Host host;
  host.put(host.table.hit, 1, group_handle(kPipeline - 1, 2));  // A pipeline that is gone had this handle.
  host.put(host.table.miss, 1, group_handle(kPipeline, 2));     // This is no miss group.
  host.put(host.table.callable, 1, group_handle(kPipeline, 9));
  CHECK(host.run(0.25f, 0, false) == "220");
  const std::string fault = host.run(0.25f, 1, false);
  CHECK_THAT(fault, Contains("needs hit record 1 ("));
  CHECK_THAT(fault, Contains(", whose handle is no hit group of this pipeline"));
  CHECK_THAT(host.run(9, 1, false), Contains("needs miss record 1, whose handle is no miss group"));
  CHECK_THAT(host.run(0, 1, true), Contains("needs callable record 1, whose handle is no callable group"));
  host.table.callable.bytes = 32;
  CHECK_THAT(host.run(0, 1, true), Contains("needs callable record 1, and the binding table has 1"));
}

TEST_CASE("a table without ray generation, or with a stride that Vulkan forbids, is refused") {
  Host host;
  host.table.miss.stride = 48;
  CHECK_THROWS_WITH(host.run(0, 0, false), Contains("the stride of the miss region is 48"));
  host.table.miss.stride = 8192;
  CHECK_THROWS_WITH(host.run(0, 0, false), Contains("at most 4096"));
  host.table.miss.stride = 64;
  host.put(host.table.raygen, 0, group_handle(kPipeline, 1));
  CHECK_THROWS_WITH(host.run(0, 0, false), Contains("holds no ray generation group of the pipeline"));
  host.table.raygen.base = 0;
  CHECK_THROWS_WITH(host.run(0, 0, false), Contains("holds no ray generation group"));
}

}  // namespace
}  // namespace glint::pipeline::device_table_test
