// Renders one frame of a scene with a built-in workload: compile, upload, launch, run, read back.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/cost_map.h"
#include "base/profile_table.h"
#include "base/stats.h"
#include "base/trace_table.h"
#include "core/residency.h"
#include "exec/executor.h"
#include "frontend/compile.h"
#include "pipeline/launch_watch.h"
#include "pipeline/params.h"
#include "pipeline/run_profile.h"
#include "scenes/camera.h"
#include "scenes/scene.h"

namespace glint::pipeline {

using Workload = scenes::Workload;
class StructureCache;

// Says what becomes of the acceleration structures when a scene moves: all are built anew, or the trees that
// were built for the first frame are fitted to where everything is (rtunit/structure/refit.h). With
// RefitBottom only bottom levels are fitted, and the top level is built anew.
enum class StructureUpdate : uint8_t { Rebuild, Refit, RefitBottom };

struct RenderJob {
  scenes::Scene scene;
  StructureUpdate update = StructureUpdate::Rebuild;  // of a scene that moves
  Workload workload = Workload::PathTracing;
  scenes::RenderParams frame;
  GpuParams gpu;
  bool timing = true;
  // With true, every cycle is simulated. This is slow and serves to check the skipping.
  bool no_skip = false;
  uint32_t threads = 1;                       // threads of the host (HostOptions)
  StructureCache* structure_cache = nullptr;  // null: every structure is built
  std::string shader_dir;                     // folder with raygen.rgen, miss.rmiss, triangle.rchit and so on
  frontend::GlslOptions glsl;
  exec::PrintLog* prints = nullptr;  // what the shaders print
  LaunchWatch watch;
  exec::OnFault on_fault = exec::OnFault::Stop;
  Observation observe;  // what to note of a run of the timing machine; `heat` serves either machine
};

// Holds what either machine counts.
struct RayCounts {
  uint64_t rays = 0, nodes = 0, box_tests = 0, triangle_tests = 0;
};

// Holds sizes of the acceleration structures.
struct StructureCounts {
  uint64_t bytes = 0, triangles = 0, procedurals = 0, bottom_levels = 0, instances = 0;
  uint32_t top_depth = 0, bottom_depth = 0;
};

struct ClassCounts {
  uint64_t instructions = 0;  // warp instructions
  uint64_t lanes = 0;         // lane instructions
  uint64_t latency = 0;       // cycles from issue to completion, summed; 0 on the functional machine
};

class RunStats;  // owns the tree of statistics and the machine that counts them

struct RenderResult {
  RenderResult();
  ~RenderResult();
  RenderResult(RenderResult&&) noexcept;
  RenderResult& operator=(RenderResult&&) noexcept;

  uint32_t width = 0, height = 0;
  std::vector<float> rgba;           // what the shader stored to binding 2, row 0 first
  exec::ImageView picture;           // where its texels lay; address_of() a pixel of `rgba` is its texel
  exec::NotFiniteStores not_finite;  // which instructions stored to images what is not finite
  std::map<uint32_t, std::string> store_lines;  // source lines of these instructions
  std::vector<float> accumulation;              // binding 1, the sum over samples
  LaunchEnd end = LaunchEnd::Whole;             // otherwise all that follows is of a part of the launch
  LaunchProgress progress;                      // how far a launch came that was ended early
  uint64_t cycles = 0;                          // cycles of the timing machine
  uint64_t warp_instructions = 0, lane_instructions = 0;
  ClassCounts by_class[size_t(isa::Class::Count)];
  RayCounts rays;
  StructureCounts structures;
  core::Residency residency;          // the blocks and warps that fit on a core of the timing machine
  exec::FaultLog faults;              // the faults that World::on_fault let pass
  std::vector<std::string> warnings;  // warnings of compiling the shaders
  ProfileTable profile;               // profile of the timing machine, if one was asked for
  SeriesTable series;
  std::vector<CostMap> costs;  // maps of cost, if they were asked for
  TraceTable trace;
  double wall_seconds = 0;  // time of the run alone, without compiling and building
  std::unique_ptr<RunStats> stats;
  const stats::Group& statistics() const;  // root of the tree
  // Adds what a launch on the same machine, after this one, has counted: times, counts and statistics. What
  // belongs to one launch alone, such as profile and picture, stays.
  void add(const RenderResult& next);
};

// Runs the launch of a world on either machine. The result has everything except pictures, structures and
// warnings. The machine runs on `threads` threads of the host, and with `no_skip` the timing machine
// simulates every cycle (HostOptions). `observe` says what else to note of a timing run. Throws as render()
// does.
RenderResult run_world(const exec::World& world, const GpuParams& gpu, bool timing, bool no_skip,
                       uint32_t threads, const LaunchWatch& watch, const Observation& observe = {});

// Renders a frame. Throws UserError or UnsupportedError before anything runs, Error(Exit::Fault) with place
// and launch id when the shaders do something wrong, and Error(Exit::Stuck) when the machine makes no
// progress.
RenderResult render(const RenderJob& job);

// Renders a frame in less memory: it frees the vertices, indices and texels of job.scene once they are
// uploaded.
RenderResult render_and_drain(RenderJob& job);

}  // namespace glint::pipeline
