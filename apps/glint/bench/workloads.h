// Lists what can be run by name: the shader sets, LumiBench's 46 workloads, each a scene with a shader set,
// and the compute programs.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/camera.h"

namespace glint::app {

struct WorkloadInfo {
  std::string_view name, folder, doc;  // `folder` is the one in shaders/
  scenes::Workload workload;
};
inline constexpr std::array<WorkloadInfo, 3> kWorkloads{{
    {"pt", "path_tracing", "Path tracing with one path per sample, up to --bounces rays long.",
     scenes::Workload::PathTracing},
    {"sh", "shadow", "Hard and soft shadows, with --shadow-rays rays from each hit to the light.",
     scenes::Workload::Shadow},
    {"ao", "ambient_occlusion", "Ambient occlusion, with --ao-rays rays into the hemisphere of each hit.",
     scenes::Workload::AmbientOcclusion},
}};

// Returns the shader set of that name. Throws UserError with the nearest name when there is none.
const WorkloadInfo& find_workload(const std::string& name);

// Names a workload as the paper does: SHIP_SH. One with frames ends in _MOTION. A compute program has its own
// name alone.
struct NamedWorkload {
  std::string_view scene;        // "SHIP", or "bfs"
  std::string_view shader;       // "sh", or "" for a compute program
  bool in_subset = false;        // It is in the paper's Table 2.
  std::string_view frames = {};  // "0:7", as the option --frames names them; "": it is one still frame
  uint64_t num_frames = 1;
  bool is_program() const { return shader.empty(); }
  std::string name() const;
};

// Returns all 46 workloads: pt, sh and ao of each scene, by the scenes' triangles in the paper. CHSNT has
// only pt.
std::vector<NamedWorkload> lumibench();

// Returns the workloads whose scenes move: several frames each.
std::vector<NamedWorkload> lumibench_motion();

// Returns all of those, and the programs of the compute suite behind them.
std::vector<NamedWorkload> all_workloads();

// Returns the workloads that the given names stand for. A name is that of a suite (`lumibench`, `subset`,
// `lumibench-motion`, `compute`), a scene, a shader set or a workload, in any case of letters. Each workload
// appears once, in the order of all_workloads(). A scene and a shader set stand for still workloads. Throws
// UserError with the nearest name for an unknown name.
std::vector<NamedWorkload> select_workloads(const std::vector<std::string>& names);

// Holds scene and shader set of a name like SHIP_SH. Every scene may stand with every set. The names of
// lumibench_motion() have frames, too.
struct SceneAndShader {
  std::string scene, shader, frames = {};
};
std::optional<SceneAndShader> split_workload(const std::string& name);

}  // namespace glint::app
