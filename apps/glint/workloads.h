// The built-in workloads by the names of the command line: LumiBench's PT, SH and AO.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <string_view>

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

}  // namespace glint::app
