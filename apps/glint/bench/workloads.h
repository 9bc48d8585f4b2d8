// What there is to run by name: the shader sets, and the 46 workloads of LumiBench, each a scene with a
// shader set.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/camera.h"

namespace glint::app {

struct WorkloadInfo {
  std::string_view name, folder, doc;  // folder in shaders/
  scenes::Workload workload;
};
inline constexpr std::array<WorkloadInfo, 3> kWorkloads{{
    {"pt", "path_tracing", "Path tracing: one path a sample, up to --bounces rays long.",
     scenes::Workload::PathTracing},
    {"sh", "shadow", "Hard and soft shadows: --shadow-rays to the light from each hit.",
     scenes::Workload::Shadow},
    {"ao", "ambient_occlusion", "Ambient occlusion: --ao-rays into the hemisphere of each hit.",
     scenes::Workload::AmbientOcclusion},
}};

// UserError with the nearest name when there is none.
const WorkloadInfo& find_workload(const std::string& name);

// A workload as the paper names it: SHIP_SH.
struct NamedWorkload {
  std::string_view scene;   // "SHIP"
  std::string_view shader;  // "sh"
  bool in_subset = false;   // of the paper's Table 2
  std::string name() const;
};

// All 46: scenes by the triangles that the paper gives, pt, sh and ao of each; CHSNT has pt alone.
std::vector<NamedWorkload> lumibench();

// Names of suites (`lumibench`, `subset`), scenes, shader sets and workloads, in any case, to workloads: each
// once, in the order of lumibench(). UserError with the nearest name for one that is none.
std::vector<NamedWorkload> select_workloads(const std::vector<std::string>& names);

// Scene and shader set of a name like SHIP_SH, of every scene with every set; nothing when it is not of that
// form.
struct SceneAndShader {
  std::string scene, shader;
};
std::optional<SceneAndShader> split_workload(const std::string& name);

}  // namespace glint::app
