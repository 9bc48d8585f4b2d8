// Estimates memory and time of a run from its scene's triangles and textures, and from measured times.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/bench/estimate.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>

#include "compute/program.h"

namespace glint::app {
namespace {

// Says what a scene needs. Triangles and texture bytes are those of the paper's scenes (original data has no
// more). The seconds are of a generated scene at 128x128, 2 spp on `mobile`, for pt, sh and ao. They were
// measured once on a busy machine and divided by its load, so only their ratios count.
struct SceneNeeds {
  std::string_view scene;
  double triangles, texture_bytes;
  double pt, sh, ao;
};
constexpr SceneNeeds kNeeds[] = {
    {"WKND", 0, 0, 2.7, 1.1, 2.9},
    {"SHIP", 6.3e3, 0, 2.3, 1.4, 2.6},
    {"BUNNY", 144e3, 0, 5.8, 1.3, 2.0},
    {"SPNZA", 262e3, 80e6, 5.2, 3.8, 3.7},
    {"CHSNT", 313e3, 8e6, 9.2, 0.0, 0.0},
    {"BATH", 424e3, 0, 9.5, 2.4, 5.2},
    {"REF", 449e3, 0, 7.8, 3.6, 3.6},
    {"CRNVL", 450e3, 0, 3.6, 2.6, 4.4},
    {"FOX", 1.6e6, 0, 8.9, 7.2, 15.6},
    {"PARTY", 1.7e6, 0, 10.6, 6.2, 12.9},
    {"SPRNG", 1.9e6, 0, 10.5, 7.3, 22.3},
    {"LANDS", 3.3e6, 0, 8.4, 4.8, 9.3},
    {"FRST", 4.2e6, 0, 7.2, 8.3, 10.9},
    {"PARK", 6.0e6, 0, 14.5, 11.0, 26.1},
    {"CAR", 12.7e6, 504e6, 18.3, 15.5, 16.0},
    {"ROBOT", 20.6e6, 0, 21.8, 16.0, 21.6},
};

// The measured peaks of the generated scenes are 44 to 93 % of what these constants give.
constexpr double kProgram = 150e6;  // bytes without a scene
// These are the bytes of a triangle: geometry, its copies while it is built and uploaded, structures.
constexpr double kPerTriangle = 200;
constexpr double kFromFiles = 2;          // guess: the text, and the vertices before they are merged
constexpr double kPerPixel = 64;          // bytes: pictures and their copies
constexpr double kFunctionalSpeedUp = 5;  // of the functional machine, about

// Returns the needs of a scene. A scene that is not in the table is taken to need as much as the largest one,
// because too much is safer than too little.
const SceneNeeds& needs_of(std::string_view scene) {
  const auto found = std::find_if(std::begin(kNeeds), std::end(kNeeds),
                                  [&](const SceneNeeds& needs) { return needs.scene == scene; });
  return found != std::end(kNeeds) ? *found : std::end(kNeeds)[-1];
}

// Returns a number of a file, which holds "NAME: NUMBER kB" lines or, when `name` is empty, one number.
// Returns 0 when there is none.
uint64_t number_in(const std::string& path, const std::string& name = {}) {
  std::ifstream in(path);
  for (std::string word; in >> word;) {
    if (name.empty() && word.find_first_not_of("0123456789") == std::string::npos) return std::stoull(word);
    uint64_t value = 0;
    if (!name.empty() && word == name && in >> value) return value;
  }
  return 0;
}

}  // namespace

uint64_t memory_estimate(const compute::Program& program, bool small) {
  return uint64_t(kProgram + (small ? 0 : program.full_megabytes * 1e6));
}

double time_weight(const compute::Program& program, bool small, bool timing) {
  return (small ? program.small_seconds : program.full_seconds) / (timing ? 1 : kFunctionalSpeedUp);
}

uint64_t memory_estimate(const NamedWorkload& workload, uint64_t pixels, bool from_files) {
  const SceneNeeds& needs = needs_of(workload.scene);
  return uint64_t(kProgram + kPerTriangle * (from_files ? kFromFiles : 1) * needs.triangles +
                  2 * needs.texture_bytes + kPerPixel * double(pixels));
}

double time_weight(const NamedWorkload& workload, bool timing, uint64_t pixels, uint64_t samples) {
  const SceneNeeds& needs = needs_of(workload.scene);
  const double loading = 0.6e-6 * needs.triangles + 0.1;
  const double measured = workload.shader == "pt" ? needs.pt : workload.shader == "sh" ? needs.sh : needs.ao;
  const double simulating = std::max(0.1, measured - loading) * double(pixels * samples) / (128 * 128 * 2);
  return loading + double(workload.num_frames) * (timing ? simulating : simulating / kFunctionalSpeedUp);
}

uint64_t available_memory() {
  uint64_t available = number_in("/proc/meminfo", "MemAvailable:") * 1024;
  const uint64_t limit = number_in("/sys/fs/cgroup/memory.max"),
                 used = number_in("/sys/fs/cgroup/memory.current");
  if (limit > used && (available == 0 || limit - used < available)) available = limit - used;
  return available;
}

}  // namespace glint::app
