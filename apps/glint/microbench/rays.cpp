// Defines probes of ray tracing as two launches each, whose difference is the cost of the rays between them.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/microbench/rays.h"

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/glint/run/frame_files.h"
#include "pipeline/render.h"
#include "report/files/run_directory.h"
#include "scenes/mesh.h"

namespace glint::app {
namespace {

constexpr uint32_t kWidth = 256, kRowsPerCore = 4;  // of launches that fill a machine: 1,024 threads a core
constexpr uint32_t kAnywhere = 2654435761;  // an odd step, which visits the targets of a grid in no order
constexpr float kOnTriangle = 0.25f, kBesideTriangle = 0.5f, kBesideGrid = -10;

// Describes the rays of one launch. The names of the middle are those of shaders/ray_probes/raygen.rgen.
struct Rays {
  uint32_t each = 1;  // rays of a thread, one after another
  uint32_t side = 1, targets = 1, ray_step = 0, thread_step = 0;
  float place = kOnTriangle;
  uint32_t layers = 1;  // triangles behind each other in every cell
  bool fills = false;   // as many threads as fill the machine; otherwise one
};

// Says what a probe's row is, given the difference of its two launches.
enum class Row : uint8_t { CyclesPerRay, RaysPerCycle, TestsPerCycle };

struct Probe {
  std::string name, param;
  Row row;
  Rays few, many;
};

scenes::Scene scene_of(const Rays& rays) {
  scenes::Scene scene;
  scene.name = "probe";
  scene.materials.push_back({});
  scenes::Model model;
  model.name = "grid";
  for (uint32_t cell = 0; cell < rays.side * rays.side; ++cell)
    for (uint32_t layer = 0; layer < rays.layers; ++layer) {
      const auto x = float(cell % rays.side), y = float(cell / rays.side), z = -float(layer);
      const auto corner = [&](float dx, float dy) {
        return scenes::add_vertex(model, {x + dx, y + dy, z}, {0, 0, 1}, 0);
      };
      const uint32_t a = corner(0, 0), b = corner(0.875f, 0), c = corner(0, 0.875f);
      scenes::add_triangle(model, a, b, c);
    }
  scene.models.push_back(std::move(model));
  return scene;
}

pipeline::RenderJob job_of(const Rays& rays, const std::string& shader_dir, uint32_t cores) {
  pipeline::RenderJob job;
  job.scene = scene_of(rays);
  job.shader_dir = shader_dir;
  job.frame.width = rays.fills ? kWidth : 1;
  job.frame.height = rays.fills ? kRowsPerCore * cores : 1;
  job.glsl.specialization = {{0, rays.each},        {1, rays.side},
                             {2, rays.targets},     {3, rays.ray_step},
                             {4, rays.thread_step}, {5, std::bit_cast<uint32_t>(rays.place)}};
  return job;
}

// Returns the rays of a launch, over all threads.
double count_of(const Rays& rays, uint32_t cores) {
  return rays.each * (rays.fills ? double(kWidth) * kRowsPerCore * cores : 1);
}

uint64_t cycles_of(const Rays& rays, const std::string& shader_dir, const pipeline::GpuParams& gpu) {
  pipeline::RenderJob job = job_of(rays, shader_dir, gpu.cores);
  job.gpu = gpu;
  return pipeline::render(job).cycles;
}

// Returns what the difference of a probe's launches counts: rays, or tests of the further layers.
double amount_of(const Probe& probe, uint32_t cores) {
  if (probe.row == Row::TestsPerCycle)
    return count_of(probe.many, cores) * (probe.many.layers - probe.few.layers);
  return count_of(probe.many, cores) - count_of(probe.few, cores);
}

double measure(const Probe& probe, const std::string& shader_dir, const pipeline::GpuParams& gpu) {
  const double cycles =
      double(cycles_of(probe.many, shader_dir, gpu)) - double(cycles_of(probe.few, shader_dir, gpu));
  const double amount = amount_of(probe, gpu.cores);
  return probe.row == Row::CyclesPerRay ? cycles / amount : amount / cycles;
}

const char* unit_of(Row row) {
  return row == Row::CyclesPerRay ? "cycle" : row == Row::RaysPerCycle ? "ray/cycle" : "test/cycle";
}

// Adds a probe whose launches differ in the number of rays.
void add(std::vector<Probe>& to, const std::string& name, const std::string& param, Row row, Rays rays,
         uint32_t few, uint32_t many) {
  Probe probe{name, param, row, rays, rays};
  probe.few.each = few, probe.many.each = many;
  to.push_back(std::move(probe));
}

std::vector<Probe> probes() {
  std::vector<Probe> out;
  const auto triangles = [](uint32_t side) { return fmt::format("triangles={}", side * side); };
  for (const uint32_t side : {1u, 4u, 16u, 64u, 256u})
    add(out, "hit of one ray", triangles(side), Row::CyclesPerRay, {.side = side}, 8, 40);
  add(out, "hit of one ray anywhere", triangles(256), Row::CyclesPerRay, {.side = 256, .ray_step = kAnywhere},
      64, 192);
  add(out, "miss of one ray", triangles(1), Row::CyclesPerRay, {.place = kBesideGrid}, 8, 40);
  for (const uint32_t side : {1u, 16u, 256u})
    add(out, "rays to one place", triangles(side), Row::RaysPerCycle, {.side = side, .fills = true}, 2, 6);
  for (const uint32_t side : {16u, 64u, 256u})
    add(out, "rays to anywhere", triangles(side), Row::RaysPerCycle,
        {.side = side, .ray_step = kAnywhere, .thread_step = kAnywhere, .fills = true}, 2, 6);
  for (const uint32_t targets : {1u, 2u, 4u, 8u, 16u, 32u})
    add(out, "places of a warp's rays", fmt::format("places={}", targets), Row::RaysPerCycle,
        {.side = 256, .targets = targets, .ray_step = 1, .fills = true}, 2, 6);
  // The rays pass beside triangles, but within their boxes, so every triangle of a cell is tested.
  Probe tests{"triangles in one ray's way", "triangles=16..64", Row::TestsPerCycle, {}, {}};
  tests.few = {.each = 2, .place = kBesideTriangle, .layers = 16, .fills = true};
  tests.many = tests.few, tests.many.layers = 64;
  out.push_back(tests);
  return out;
}

}  // namespace

std::vector<MicroBench> ray_benchmarks(const std::string& shader_dir) {
  std::vector<MicroBench> out;
  for (const Probe& probe : probes())
    out.push_back(
        {"rays", probe.name, probe.param, unit_of(probe.row),
         [probe, shader_dir](const pipeline::GpuParams& gpu) { return measure(probe, shader_dir, gpu); }});
  return out;
}

void write_ray_frames(const std::string& shader_dir, const std::string& folder, uint32_t cores) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Probe& probe : probes()) {
    const std::string number = fmt::format("{:02}", list.size());
    const std::array<std::string, 2> names = {"rays_" + number + "_few", "rays_" + number + "_many"};
    write_frame(job_of(probe.few, shader_dir, cores), names[0], folder + "/" + names[0]);
    write_frame(job_of(probe.many, shader_dir, cores), names[1], folder + "/" + names[1]);
    list.push_back({{"group", "rays"},
                    {"name", probe.name},
                    {"param", probe.param},
                    {"unit", unit_of(probe.row)},
                    {"few", names[0]},
                    {"many", names[1]},
                    {"amount", amount_of(probe, cores)}});
  }
  report::write_file(folder + "/probes.json", list.dump(1) + "\n");
}

}  // namespace glint::app
