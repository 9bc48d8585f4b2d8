// Builds the laboratory's world: memory, structures, descriptors and stack sizes.
// SPDX-License-Identifier: Apache-2.0
#include "tests/shaders/ray_lab.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/format.h>
#include <span>

#include "base/registry.h"
#include "isa/verify.h"
#include "pipeline/binding_table.h"
#include "pipeline/functional_machine.h"
#include "pipeline/software_traversal.h"
#include "pipeline/timing_machine.h"
#include "rtunit/structure/build.h"
#include "tests/support/kept_shaders.h"

namespace glint::test {
namespace {

constexpr uint64_t kRayBudget = 2'000'000;  // instructions per warp, far more than any shader here needs

void bind(exec::World& world, uint32_t set, uint32_t binding, uint64_t address_or_handle,
          uint64_t bytes_or_count) {
  const uint64_t descriptor[2] = {address_or_handle, bytes_or_count};
  std::memcpy(world.constant_bank.data() + set * isa::kSetBytes + binding * isa::kDescriptorBytes, descriptor,
              sizeof(descriptor));
}

rt::StructureInfo quads(mem::AddressSpace& memory, const rt::BuildOptions& options) {
  std::vector<std::array<float, 3>> corners;
  for (float x : {0.0f, 1.0f})
    for (const auto& [dx, y] : {std::pair{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 6.0f}, {0.0f, 6.0f}})
      corners.push_back({x + dx, y, 0});
  const uint32_t indices[2][6] = {{0, 1, 2, 0, 2, 3}, {4, 5, 6, 4, 6, 7}};
  rt::BottomLevel level;
  for (int g = 0; g < 2; ++g) {
    rt::Geometry geometry;
    geometry.positions = std::as_bytes(std::span(corners));
    geometry.indices = indices[g];
    geometry.opaque = g == 0;
    level.geometries.push_back(geometry);
  }
  return rt::build_bottom(memory, "quads", level, options);
}

rt::StructureInfo boxes(mem::AddressSpace& memory, const rt::BuildOptions& options) {
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
  return rt::build_bottom(memory, "boxes", level, options);
}

rt::StructureInfo scene(mem::AddressSpace& memory, const rt::BuildOptions& options) {
  const std::vector<rt::StructureInfo> bottoms{quads(memory, options), boxes(memory, options)};
  const rt::Instance first{{1, 0, 0, 2, 0, 1, 0, 0, 0, 0, 1, 0}, 100, 0xff, 0, 0, 0};
  const rt::Instance second{{1, 0, 0, 4, 0, 1, 0, 0, 0, 0, 3, 2}, 200, 0x0f, 0, 0, 0};
  const rt::Instance third{{1, 0, 0, 6, 0, 1, 0, 0, 0, 0, 1, 0}, 300, 0xff, 4, 0, 1};
  return rt::build_top(memory, "top", std::vector<rt::Instance>{first, second, third}, bottoms, options);
}

std::vector<std::byte> as_bytes(const std::vector<uint32_t>& words) {
  const auto bytes = std::as_bytes(std::span(words));
  return {bytes.begin(), bytes.end()};
}
void add(pipeline::TableRegion& region, uint32_t group, const std::vector<std::vector<uint32_t>>& data) {
  const size_t i = region.records.size();
  region.records.push_back({group, i < data.size() ? as_bytes(data[i]) : std::vector<std::byte>{}});
}

struct Shaders {
  std::vector<isa::Program> programs;
  std::map<std::string, uint32_t> index;

  uint32_t shader(const std::string& file, const LabShaders& shaders, const LabOptions& options) {
    if (file.empty()) return exec::kNoShader;
    const auto [it, is_new] = index.emplace(file, uint32_t(programs.size()));
    if (is_new) programs.push_back(compile_lab(file, shaders.glsl, options));
    return it->second;
  }
};

pipeline::TableInput make_table(const RayLab& lab, const LabShaders& files, Shaders& shaders,
                                const LabOptions& options) {
  pipeline::TableInput table;
  const auto general = [&](const std::string& file) {
    if (file.empty()) return pipeline::kNoGroup;
    table.groups.push_back({shaders.shader(file, files, options), {}});
    return uint32_t(table.groups.size() - 1);
  };
  table.raygen = {general(files.raygen), as_bytes(lab.raygen_data)};
  for (const std::string& file : files.miss) add(table.miss, general(file), lab.miss_data);
  for (const std::string& file : files.callable) add(table.callable, general(file), lab.callable_data);
  for (const LabShaders::Group& group : files.hit) {
    table.groups.push_back(
        {exec::kNoShader,
         {shaders.shader(group.closest, files, options), shaders.shader(group.any, files, options),
          shaders.shader(group.intersection, files, options)}});
    add(table.hit, uint32_t(table.groups.size() - 1), lab.hit_data);
  }
  return table;
}

void add_images(exec::World& world, mem::AddressSpace& memory) {
  using Format = exec::ImageView::Format;
  const Address storage = memory.allocate("image", RayLab::kImageWidth * RayLab::kImageHeight * 16);
  world.images.push_back({Format::Rgba32Float, RayLab::kImageWidth, RayLab::kImageHeight, storage, "image"});
  bind(world, 0, 2, 0, 1);
  // Every texel of texture t is (64 t + 16, 0, 255, 128) of 255.
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

std::string lab_file(const std::string& file) {
  return std::string(GLINT_SOURCE_DIR) + "/tests/shaders/glsl/" + file;
}

isa::Program compile_lab(const std::string& file, const frontend::GlslOptions& glsl,
                         const LabOptions& options) {
  Diagnostics diagnostics;
  frontend::GlslOptions kept = glsl;
  kept.cache = kept_shaders();
  isa::Program program = frontend::compile_file(
      lab_file(file), kept, {options.max_registers, options.schedule, false, options.software}, diagnostics);
  isa::verify(program, diagnostics);
  diagnostics.throw_if_errors();
  if (!diagnostics.messages().empty()) throw UserError(file + ": " + diagnostics.messages().front());
  return program;
}

std::vector<uint32_t> RayLab::run(const LabOptions& options) {
  Shaders shaders;
  exec::World world;
  mem::AddressSpace memory;
  world.memory = &memory;
  world.constant_bank.resize(isa::kConstantBankBytes);
  world.launch_size = {kWidth, kHeight, 1};
  world.max_trace_depth = max_trace_depth;
  world.any_hit = Registry<rt::AnyHitMode>::instance().entry(options.any_hit).make_default({});
  const pipeline::TableInput table = make_table(*this, shaders_, shaders, options);
  pipeline::GpuParams gpu;
  gpu.cores = 2;
  gpu.core.instruction_budget = kRayBudget;
  gpu.compiler.max_registers = options.max_registers;
  gpu.rt.unit = options.software ? rt::kSoftware : rt::kHardware;
  pipeline::add_traversal(shaders.programs, gpu, kept_shaders());
  const exec::Image linked = exec::link(shaders.programs);
  world.image = &linked;
  pipeline::build_binding_table(world, memory, table);
  world.max_callable_depth = max_callable_depth;
  world.local_bytes = pipeline::stack_bytes(linked, max_trace_depth, max_callable_depth);

  const rt::StructureInfo top = scene(memory, {options.node_format});
  pipeline::place_records(world, top.stack_need);
  bind(world, 0, 0, top.address, top.bytes);
  const Address structure_words = memory.allocate("the top level's address", 8);
  memory.write(structure_words, &top.address, 8);
  bind(world, 0, 30, structure_words, 8);
  const uint64_t structures[4] = {0, 0, top.address,
                                  // The table has the descriptors of a null structure and of the top level.
                                  top.bytes};
  const Address array = memory.allocate("structures", sizeof structures);
  memory.write(array, structures, sizeof structures);
  bind(world, 0, 31, array, 2);
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
    std::memcpy(world.constant_bank.data() + isa::kPushConstantOffset, push_constants.data(),
                push_constants.size() * 4);

  world.on_fault = options.on_fault;
  if (options.timing) {
    pipeline::TimingMachine machine(gpu, world, false);
    machine.run({});
    faults = machine.passed();
  } else {
    faults = pipeline::run_functional(world, kRayBudget, {}).faults;
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
  const auto in_format = [](const char* node_format, bool timing) {
    LabOptions out;
    out.timing = timing;
    out.node_format = node_format;
    return out;
  };
  const auto in_code = [](uint32_t registers, bool timing) {
    LabOptions out{registers, true, timing};
    out.software = true;
    return out;
  };
  static const std::vector<LabOptions> kAll = {{16, true, false},
                                               {32, true, false},
                                               {64, true, false},
                                               {64, false, false},
                                               {255, true, false},
                                               {16, true, true},
                                               {64, true, true},
                                               {32, true, false, "deferred"},
                                               {64, true, true, "deferred"},
                                               in_format("bvh2", false),
                                               in_format("bvh4", true),
                                               in_format("bvh8", false),
                                               in_code(16, false),
                                               in_code(64, true)};
  return kAll;
}

std::string to_string(const LabOptions& options) {
  return fmt::format("{} registers, {}, {} machine, {} any-hit, {}", options.max_registers,
                     options.schedule ? "scheduled" : "in order", options.timing ? "timing" : "functional",
                     options.any_hit, options.node_format) +
         (options.software ? ", rays in code" : "");
}

}  // namespace glint::test
