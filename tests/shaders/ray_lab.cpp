// The laboratory's world: memory, structures, descriptors and stack sizes.
// SPDX-License-Identifier: Apache-2.0
#include "tests/shaders/ray_lab.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "isa/verify.h"
#include "pipeline/functional_machine.h"
#include "pipeline/timing_machine.h"
#include "rtunit/build.h"

namespace glint::test {
namespace {

constexpr uint32_t kRecordBytes = 32;
constexpr uint64_t kBudget = 2'000'000;  // instructions a warp: far more than any shader here needs

void bind(core::World& world, uint32_t set, uint32_t binding, uint64_t address_or_handle, uint64_t bytes_or_count) {
  const uint64_t descriptor[2] = {address_or_handle, bytes_or_count};
  std::memcpy(world.constant_bank.data() + set * isa::kSetBytes + binding * isa::kDescriptorBytes, descriptor, sizeof(descriptor));
}

rt::StructureInfo quads(mem::AddressSpace& memory) {
  std::vector<std::array<float, 3>> corners;
  for (float x : {0.0f, 1.0f})
    for (const auto& [dx, y] : {std::pair{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 6.0f}, {0.0f, 6.0f}}) corners.push_back({x + dx, y, 0});
  const uint32_t indices[2][6] = {{0, 1, 2, 0, 2, 3}, {4, 5, 6, 4, 6, 7}};
  rt::BottomLevel level;
  for (int g = 0; g < 2; ++g) {
    rt::Geometry geometry;
    geometry.positions = std::as_bytes(std::span(corners));
    geometry.indices = indices[g];
    geometry.opaque = g == 0;
    level.geometries.push_back(geometry);
  }
  return rt::build_bottom(memory, "quads", level);
}

rt::StructureInfo boxes(mem::AddressSpace& memory) {
  std::vector<rt::Bounds> bounds[2];
  for (uint32_t g = 0; g < 2; ++g)
    for (uint32_t y = 0; y < RayLab::kHeight; ++y) {
      rt::Bounds box;
      box.low = {float(g), float(y), -1};
      box.high = {float(g + 1), float(y + 1), 1};
      bounds[g].push_back(box);
    }
  rt::BottomLevel level;
  for (int g = 0; g < 2; ++g) {
    rt::Geometry geometry;
    geometry.aabbs = bounds[g];
    geometry.opaque = g == 0;
    level.geometries.push_back(geometry);
  }
  return rt::build_bottom(memory, "boxes", level);
}

rt::StructureInfo scene(mem::AddressSpace& memory) {
  const std::vector<rt::StructureInfo> bottoms{quads(memory), boxes(memory)};
  const rt::Instance first{{1, 0, 0, 2, 0, 1, 0, 0, 0, 0, 1, 0}, 100, 0xff, 0, 0, 0};
  const rt::Instance second{{1, 0, 0, 4, 0, 1, 0, 0, 0, 0, 3, 2}, 200, 0x0f, 0, 0, 0};
  const rt::Instance third{{1, 0, 0, 6, 0, 1, 0, 0, 0, 0, 1, 0}, 300, 0xff, 4, 0, 1};
  return rt::build_top(memory, "top", std::vector<rt::Instance>{first, second, third}, bottoms);
}

// The deepest chain of frames: the ray generation shader, then at each depth a hit or miss shader, or an
// any-hit shader below an intersection shader.
uint32_t stack_bytes(const std::vector<isa::Program>& programs, uint32_t depth) {
  uint32_t largest[size_t(isa::Stage::Compute) + 1] = {};
  for (const isa::Program& program : programs) {
    uint32_t& bytes = largest[size_t(program.stage)];
    bytes = std::max(bytes, program.local_bytes);
  }
  const auto of = [&](isa::Stage stage) { return largest[size_t(stage)]; };
  const uint32_t called =
      std::max({of(isa::Stage::ClosestHit), of(isa::Stage::Miss), of(isa::Stage::Intersection) + of(isa::Stage::AnyHit)});
  return (of(isa::Stage::RayGeneration) + of(isa::Stage::Compute) + depth * called + 15) / 16 * 16;
}

struct Pipeline {
  std::vector<isa::Program> programs;
  std::map<std::string, uint32_t> index;

  uint32_t shader(const std::string& file, const LabShaders& shaders, const LabOptions& options) {
    if (file.empty()) return core::kNoShader;
    const auto [it, is_new] = index.emplace(file, uint32_t(programs.size()));
    if (is_new) programs.push_back(compile_lab(file, shaders.glsl, options));
    return it->second;
  }
};

void add_images(core::World& world, mem::AddressSpace& memory) {
  using Format = core::ImageView::Format;
  const Address storage = memory.allocate("image", RayLab::kImageWidth * RayLab::kImageHeight * 16);
  world.images.push_back({Format::Rgba32Float, RayLab::kImageWidth, RayLab::kImageHeight, storage, "image"});
  bind(world, 0, 2, 0, 1);
  // Texture t: every texel is (64 t + 16, 0, 255, 128) of 255.
  for (uint8_t t = 0; t < 2; ++t) {
    std::vector<uint8_t> texels;
    for (int i = 0; i < 4; ++i) texels.insert(texels.end(), {uint8_t(64 * t + 16), 0, 255, 128});
    const Address base = memory.allocate(fmt::format("texture {}", t), texels.size());
    memory.write(base, texels.data(), texels.size());
    world.images.push_back({Format::Rgba8Unorm, 2, 2, base, fmt::format("texture {}", t)});
  }
  bind(world, 0, 3, 1, 2);
}

}  // namespace

std::string lab_file(const std::string& file) { return std::string(GLINT_SOURCE_DIR) + "/tests/shaders/glsl/" + file; }

isa::Program compile_lab(const std::string& file, const frontend::GlslOptions& glsl, const LabOptions& options) {
  Diagnostics diagnostics;
  isa::Program program = frontend::compile_file(lab_file(file), glsl, {options.max_registers, options.schedule}, diagnostics);
  isa::verify(program, diagnostics);
  diagnostics.throw_if_errors();
  if (!diagnostics.messages().empty()) throw UserError(file + ": " + diagnostics.messages().front());
  return program;
}

std::vector<uint32_t> RayLab::run(const LabOptions& options) {
  Pipeline pipeline;
  core::World world;
  mem::AddressSpace memory;
  world.memory = &memory;
  world.constant_bank.resize(isa::kConstantBankBytes);
  world.launch_size = {kWidth, kHeight, 1};
  world.max_trace_depth = max_trace_depth;
  world.raygen = pipeline.shader(shaders_.raygen, shaders_, options);
  for (const std::string& file : shaders_.miss) world.miss.push_back(pipeline.shader(file, shaders_, options));
  for (const LabShaders::Group& group : shaders_.hit)
    world.hit.push_back({pipeline.shader(group.closest, shaders_, options), pipeline.shader(group.any, shaders_, options),
                         pipeline.shader(group.intersection, shaders_, options)});
  const core::Image linked = core::link(pipeline.programs);
  world.image = &linked;
  world.local_bytes = stack_bytes(pipeline.programs, max_trace_depth);
  core::place_plain_table(world, memory.allocate("binding table", core::plain_table_bytes(world)));

  const rt::StructureInfo top = scene(memory);
  bind(world, 0, 0, top.address, top.bytes);
  const uint64_t result_bytes = uint64_t(kLanesUsed) * words_per_lane * 4;
  const Address results = memory.allocate("results", result_bytes);
  bind(world, 0, 1, results, result_bytes);
  add_images(world, memory);
  std::map<uint32_t, Address> address;
  for (uint32_t set = 0; set < 2; ++set)
    for (const auto& [binding, words] : set == 0 ? buffers : set1) {
      const Address at = memory.allocate(fmt::format("set {} binding {}", set, binding), words.size() * 4);
      memory.write(at, words.data(), words.size() * 4);
      bind(world, set, binding, at, words.size() * 4);
      if (set == 0) address[binding] = at;
    }
  if (!push_constants.empty())
    std::memcpy(world.constant_bank.data() + isa::kPushConstantOffset, push_constants.data(), push_constants.size() * 4);

  if (options.timing) {
    pipeline::GpuParams gpu;
    gpu.cores = 2;
    gpu.core.instruction_budget = kBudget;
    pipeline::TimingMachine(gpu, world, false).run({});
  } else {
    pipeline::run_functional(world, kBudget, {});
  }

  const auto texels = memory.view<float>(world.images[0].base, kImageWidth * kImageHeight * 4);
  image.assign(texels.begin(), texels.end());
  for (const auto& [binding, at] : address) {
    const auto words = memory.view<uint32_t>(at, buffers[binding].size());
    buffers_after[binding].assign(words.begin(), words.end());
  }
  const auto words = memory.view<uint32_t>(results, result_bytes / 4);
  return {words.begin(), words.end()};
}

const std::vector<LabOptions>& all_lab_options() {
  static const std::vector<LabOptions> kAll = {{16, true, false}, {32, true, false}, {64, true, false},
                                               {64, false, false}, {255, true, false}, {16, true, true}, {64, true, true}};
  return kAll;
}

std::string to_string(const LabOptions& options) {
  return fmt::format("{} registers, {}, {} machine", options.max_registers, options.schedule ? "scheduled" : "in order",
                     options.timing ? "timing" : "functional");
}

}  // namespace glint::test
