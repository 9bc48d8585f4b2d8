// Tests that launches built from host state read what the host bound, and share what the host keeps.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/launch_builder.h"

#include <numeric>
#include <string>
#include <vector>

#include "pipeline/functional_machine.h"
#include "tests/support/catch.h"

namespace glint::pipeline::launch_builder_test {
namespace {

using Catch::Contains;

constexpr const char* kShader = R"(#version 460
#extension GL_EXT_nonuniform_qualifier : require
layout(constant_id = 3) const uint kFactor = 1;
layout(local_size_x = 8) in;
layout(set = 0, binding = 0) buffer Out { uint result[]; };
layout(set = 0, binding = 1) buffer In { uint value[]; } inputs[2];
layout(set = 1, binding = 0, r32ui) uniform uimage2D pictures[];
layout(push_constant) uniform Constants { uint unused, picture; };
void main() {
  const uint i = gl_GlobalInvocationID.x;
  result[i] = kFactor * (inputs[0].value[i] + inputs[1].value[i]) +
              imageLoad(pictures[nonuniformEXT(picture)], ivec2(0)).x;
}
)";

constexpr const char* kArrayOfOne = R"(#version 460
layout(local_size_x = 8) in;
layout(set = 0, binding = 0) buffer Out { uint result[]; };
layout(set = 0, binding = 1) buffer Single { uint value; } single[1];
void main() { result[gl_GlobalInvocationID.x] = single[0].value; }
)";

// Stands for a host: it has memory, a compiled shader, and a pool of images of one texel.
struct Host {
  explicit Host(const char* text = kShader) : stage(compile(text)) {}

  GpuParams gpu;
  CompiledStage stage;
  LinkedShaders shaders{{stage.program}, stage.reflection.bindings, gpu, nullptr};
  mem::AddressSpace memory;
  exec::ImagePool pool;
  Address out = place(std::vector<uint32_t>(16));

  static CompiledStage compile(const char* text) {
    Diagnostics notes;
    return compile_stage(frontend::glsl_text_to_spirv(text, "sum.comp", isa::Stage::Compute, {}),
                         {"sum.comp", "", {{3, 10}}}, {}, notes, nullptr);
  }
  Address place(const std::vector<uint32_t>& words) {
    const Address at = memory.allocate("words", words.size() * 4);
    memory.write(at, words.data(), words.size() * 4);
    return at;
  }
  exec::ImageView image(uint32_t texel) {
    exec::ImageView view;
    view.format = exec::TexelFormat::R32Uint;
    view.base = place({texel});
    return view;
  }
  void bind(LaunchBuilder& builder, uint32_t picture) {
    std::vector<uint32_t> count(16);
    std::iota(count.begin(), count.end(), 0u);
    builder.bind_buffers({0, 0}, {{out, 64}});
    builder.bind_buffers({0, 1}, {{place(count), 64}, {place(std::vector<uint32_t>(16, 7)), 64}});
    builder.set_push_constants(std::as_bytes(std::span(&picture, 1)), 4);
    builder.set_blocks(0, {2, 1, 1});
  }
  uint32_t run(const exec::World& world) {
    run_functional(world, 1000, {});
    return memory.view<uint32_t>(out, 16)[15];
  }
};

TEST_CASE("a launch reads its buffers, its push constants, its constants and its images") {
  Host host;
  LaunchBuilder builder(host.shaders, host.memory);
  host.bind(builder, 1);
  builder.bind_images({1, 0}, {host.image(1000), host.image(2000)});
  CHECK(host.run(builder.finish()) == 10 * (15 + 7) + 2000);
}

TEST_CASE("launches take images of a pool by number, and copy none") {
  Host host;
  for (uint32_t i = 0; i < 5; ++i) host.pool.images.push_back(host.image(1000 * i));
  for (uint32_t first : {0u, 3u}) {
    LaunchBuilder builder(host.shaders, host.memory, &host.pool);
    host.bind(builder, 1);
    builder.bind_pool_images({1, 0}, first, 2);
    CHECK(host.run(builder.finish()) == 10 * (15 + 7) + 1000 * (first + 1));
    CHECK(builder.world.images.empty());
  }
}

TEST_CASE("a launch's own images have numbers behind those of the pool") {
  Host host;
  host.pool.images.push_back(host.image(1));
  LaunchBuilder builder(host.shaders, host.memory, &host.pool);
  host.bind(builder, 0);
  builder.bind_images({1, 0}, {host.image(4000)});
  CHECK(host.run(builder.finish()) == 10 * (15 + 7) + 4000);
}

TEST_CASE("an image that nobody bound is a fault that names its place") {
  Host host;
  host.pool.images.push_back(host.image(1));
  LaunchBuilder builder(host.shaders, host.memory, &host.pool);
  host.bind(builder, 0);
  CHECK_THROWS_WITH(host.run(builder.finish()), Contains("set 1 binding 0 (pictures)"));
}

TEST_CASE("an array of one buffer has a table, as every array has") {
  Host host(kArrayOfOne);
  LaunchBuilder builder(host.shaders, host.memory);
  builder.bind_buffers({0, 0}, {{host.out, 64}});
  builder.bind_buffers({0, 1}, {{host.place({5}), 4}});
  builder.set_blocks(0, {2, 1, 1});
  CHECK(host.run(builder.finish()) == 5);
}

TEST_CASE("an element of an array of buffers that nobody gave is a fault that names its place") {
  Host host;
  LaunchBuilder builder(host.shaders, host.memory);
  host.bind(builder, 0);
  builder.bind_images({1, 0}, {host.image(0)});
  builder.bind_buffers({0, 1}, {{host.out, 64}});
  CHECK_THROWS_WITH(host.run(builder.finish()), Contains("set 0 binding 1"));
}

TEST_CASE("a table that the host keeps serves without an allocation of the launch") {
  Host host;
  const std::vector<uint32_t> ones(16, 1);
  const std::vector<uint64_t> table{host.place(ones), 64, host.place(ones), 64};
  const Address at = host.memory.allocate("table", 32);
  host.memory.write(at, table.data(), 32);
  LaunchBuilder builder(host.shaders, host.memory);
  builder.bind_buffers({0, 0}, {{host.out, 64}});
  builder.bind_table({0, 1}, at, 2);
  builder.bind_images({1, 0}, {host.image(0), host.image(0)});
  builder.set_blocks(0, {2, 1, 1});
  CHECK(host.run(builder.finish()) == 10 * 2);
  CHECK(builder.allocations().empty());
}

TEST_CASE("push constants up to the last byte fit, and one more is refused") {
  Host host;
  LaunchBuilder builder(host.shaders, host.memory);
  const std::vector<std::byte> bytes(1024);
  CHECK_NOTHROW(builder.set_push_constants(bytes));
  CHECK_THROWS_WITH(builder.set_push_constants(bytes, 1), Contains("there is room for 1024"));
}

}  // namespace
}  // namespace glint::pipeline::launch_builder_test
