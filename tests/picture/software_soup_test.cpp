// Tests ray queries over random triangles, boxes and instances, walked in code, against the shared traversal.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstring>
#include <iterator>
#include <string_view>

#include "pipeline/binding_table.h"
#include "pipeline/functional_machine.h"
#include "pipeline/software_traversal.h"
#include "tests/support/catch.h"
#include "tests/support/kept_shaders.h"
#include "tests/support/rt_brute.h"

using namespace glint;
using namespace glint::rt::test;

namespace {

constexpr uint32_t kRays = 1024, kRayWords = 10, kHitWords = 8;
constexpr uint64_t kBudget = 100'000'000;

// The shader takes every other triangle that is not opaque, and in boxes a hit where their even primitives
// begin.
const char* const kShader = R"(#version 460
#extension GL_EXT_ray_query : require
layout(local_size_x = 64) in;
layout(binding = 0) uniform accelerationStructureEXT scene;
layout(binding = 1) readonly buffer Rays { uint words[]; } rays;
layout(binding = 2) writeonly buffer Hits { uint words[]; } hits;
float real(uint at) { return uintBitsToFloat(rays.words[at]); }
void main() {
  const uint r = gl_GlobalInvocationID.x * 10, h = gl_GlobalInvocationID.x * 8;
  rayQueryEXT q;
  rayQueryInitializeEXT(q, scene, rays.words[r + 8], rays.words[r + 9], vec3(real(r), real(r + 1), real(r + 2)), real(r + 3),
                        vec3(real(r + 4), real(r + 5), real(r + 6)), real(r + 7));
  uint seen = 0;
  while (rayQueryProceedEXT(q)) {
    ++seen;
    const int primitive = rayQueryGetIntersectionPrimitiveIndexEXT(q, false);
    if (primitive % 2 != 0) continue;
    if (rayQueryGetIntersectionTypeEXT(q, false) == gl_RayQueryCandidateIntersectionTriangleEXT) rayQueryConfirmIntersectionEXT(q);
    else rayQueryGenerateIntersectionEXT(q, real(r + 3) + float(primitive));
  }
  hits.words[h] = rayQueryGetIntersectionTypeEXT(q, true);
  hits.words[h + 1] = floatBitsToUint(rayQueryGetIntersectionTEXT(q, true));
  hits.words[h + 2] = rayQueryGetIntersectionInstanceIdEXT(q, true);
  hits.words[h + 3] = rayQueryGetIntersectionGeometryIndexEXT(q, true);
  hits.words[h + 4] = rayQueryGetIntersectionPrimitiveIndexEXT(q, true);
  vec2 weights = vec2(0);
  if (rayQueryGetIntersectionTypeEXT(q, true) == gl_RayQueryCommittedIntersectionTriangleEXT) weights = rayQueryGetIntersectionBarycentricsEXT(q, true);
  hits.words[h + 5] = floatBitsToUint(weights.x);
  hits.words[h + 6] = floatBitsToUint(weights.y);
  hits.words[h + 7] = seen;
}
)";

// Returns faces of all kinds, some of them hidden, and the same ones twice, which gives ties.
Scene various(uint64_t seed) {
  Scene out = crowd(seed, 100);
  for (uint32_t i = 0; i < out.instances.size(); ++i) {
    out.instances[i].flags = i % 4;  // facing cull disabled, facing flipped
    out.instances[i].mask = 1u << (i % 8);
  }
  out.instances.back() = out.instances.front();
  return out;
}

std::vector<uint32_t> rays_of(uint64_t seed) {
  constexpr uint32_t kFlags[] = {0, 1, 2, 4, 5, 0x10, 0x20, 0x40, 0x80, 0x100, 0x200, 0x14};
  Random random{seed};
  std::vector<uint32_t> words;
  for (uint32_t i = 0; i < kRays; ++i) {
    const auto origin = random.point(15), direction = random.point(1);
    const float values[8] = {origin[0],    origin[1],
                             origin[2],    0.01f,
                             direction[0], i % 16 ? direction[1] : 0.0f,
                             direction[2], i % 3 ? 1e30f : 20.0f};
    for (const float value : values) words.push_back(std::bit_cast<uint32_t>(value));
    words.push_back(kFlags[random.below(std::size(kFlags))]);
    words.push_back(i % 5 ? 0xff : 0x0f);
  }
  return words;
}

// Returns the words that the shader stores.
std::vector<uint32_t> hits_of(uint64_t seed, std::string_view unit, uint32_t max_registers) {
  BuiltScene built(various(seed), "bvh6");
  pipeline::GpuParams gpu;
  gpu.rt.unit = unit;
  gpu.compiler.max_registers = max_registers;
  Diagnostics warnings;
  frontend::GlslOptions glsl;
  glsl.cache = test::kept_shaders();
  const std::vector<uint32_t> spirv =
      frontend::glsl_text_to_spirv(kShader, "soup.comp", isa::Stage::Compute, glsl);
  const frontend::BackendOptions backend{max_registers, true, false,
                                         pipeline::compiler_for(gpu).queries_call};
  std::vector<isa::Program> programs{
      frontend::compile_module(spirv, "soup.comp", {}, backend, warnings, glsl.cache).program};
  pipeline::add_traversal(programs, gpu, glsl.cache);
  const exec::Image image = exec::link(programs);
  exec::World world;
  world.image = &image;
  world.memory = &built.memory;
  world.raygen = 0;
  world.constant_bank.resize(isa::kConstantBankBytes);
  world.local_bytes = pipeline::stack_bytes(image, 1, 0);
  exec::set_blocks(world, {kRays / 64, 1, 1}, {64, 1, 1}, 0);
  pipeline::place_records(world, built.top.stack_need);
  const std::vector<uint32_t> rays = rays_of(seed + 1);
  const Address from = built.memory.allocate("rays", rays.size() * 4),
                to = built.memory.allocate("hits", kRays * kHitWords * 4);
  built.memory.write(from, rays.data(), rays.size() * 4);
  const uint64_t descriptors[] = {built.top.address,    built.top.bytes, from, rays.size() * 4, to,
                                  kRays * kHitWords * 4};
  std::memcpy(world.constant_bank.data(), descriptors, sizeof descriptors);
  pipeline::run_functional(world, kBudget, {});
  const auto words = built.memory.view<uint32_t>(to, kRays * kHitWords);
  return {words.begin(), words.end()};
}

}  // namespace

TEST_CASE(
    "ray queries over random soups find the same hits after as many candidates when rays are walked in "
    "code") {
  for (const uint64_t seed : {11, 12, 13, 14}) {
    INFO("seed " << seed);
    const std::vector<uint32_t> unit = hits_of(seed, rt::kHardware, 64),
                                code = hits_of(seed, rt::kSoftware, seed % 2 ? 64 : 24);
    uint32_t triangles = 0, boxes = 0;
    for (uint32_t ray = 0; ray < kRays; ++ray)
      triangles += unit[ray * kHitWords] == 1, boxes += unit[ray * kHitWords] == 2;
    CHECK(triangles > 100);
    CHECK(boxes > 10);
    CHECK(unit == code);
  }
}
