// Looks up shader sets and workloads by name.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/bench/workloads.h"

#include <algorithm>
#include <cctype>

#include "base/diagnostics.h"
#include "compute/program.h"
#include "scenes/scene.h"

namespace glint::app {
namespace {

// The order is that of LumiBench, Figure 7: by triangles, from few to many.
constexpr std::string_view kScenes[] = {"WKND", "SHIP",  "BUNNY", "SPNZA", "CHSNT", "BATH", "REF", "CRNVL",
                                        "FOX",  "PARTY", "SPRNG", "LANDS", "FRST",  "PARK", "CAR", "ROBOT"};
// These are the workloads of LumiBench, Table 2, one of each cluster.
constexpr std::string_view kSubset[] = {"SPNZA_AO", "BUNNY_AO", "WKND_PT", "SHIP_SH",
                                        "ROBOT_SH", "BATH_PT",  "PARK_PT", "CHSNT_PT"};
// The leaves of this scene are cut out by an any-hit shader, and the paper runs it only with path tracing.
constexpr std::string_view kPathTracingOnly = "CHSNT";

constexpr std::string_view kMotion = "_MOTION";  // at the end of a name
// One scene in which things move, one that deforms, and one through which the camera goes. A third of a
// second has the coherence of real animation from frame to frame.
constexpr std::string_view kMotionFrames = "0:7";
constexpr uint64_t kNumMotionFrames = 8;
constexpr NamedWorkload kMotions[] = {{"WKND", "pt", false, kMotionFrames, kNumMotionFrames},
                                      {"BUNNY", "sh", false, kMotionFrames, kNumMotionFrames},
                                      {"SPNZA", "ao", false, kMotionFrames, kNumMotionFrames}};

std::string upper(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = char(std::toupper(uint8_t(c)));
  return out;
}

// Returns the candidate nearest to `name` in any case of letters, or "".
std::string nearest_in_any_case(const std::string& name, const std::vector<std::string>& candidates) {
  std::vector<std::string> uppers;
  for (const std::string& candidate : candidates) uppers.push_back(upper(candidate));
  const std::string guess = nearest(upper(name), uppers);
  const auto found = std::find(uppers.begin(), uppers.end(), guess);
  return found == uppers.end() ? "" : candidates[size_t(found - uppers.begin())];
}

bool is_called(const NamedWorkload& workload, const std::string& name) {
  if (workload.is_program())
    return name == upper(workload.scene) ||
           (name == "COMPUTE" && compute::find_program(workload.scene)->form == compute::Form::Glsl);
  if (!workload.frames.empty()) return name == "LUMIBENCH-MOTION" || name == workload.name();
  return name == "LUMIBENCH" || (name == "SUBSET" && workload.in_subset) || name == workload.scene ||
         name == upper(workload.shader) || name == workload.name();
}

}  // namespace

const WorkloadInfo& find_workload(const std::string& name) {
  std::vector<std::string> names;
  for (const WorkloadInfo& info : kWorkloads) {
    if (info.name == name) return info;
    names.emplace_back(info.name);
  }
  const std::string guess = nearest(name, names);
  throw UserError({}, "there is no shader set '" + name + "', expected pt, sh or ao",
                  guess.empty() ? "" : "did you mean '" + guess + "'?");
}

std::string NamedWorkload::name() const {
  if (is_program()) return std::string(scene);
  return std::string(scene) + "_" + upper(shader) + std::string(frames.empty() ? "" : kMotion);
}

std::vector<NamedWorkload> lumibench() {
  std::vector<NamedWorkload> out;
  for (const std::string_view scene : kScenes)
    for (const WorkloadInfo& shader : kWorkloads) {
      if (scene == kPathTracingOnly && shader.workload != scenes::Workload::PathTracing) continue;
      NamedWorkload made{scene, shader.name};
      made.in_subset = std::find(std::begin(kSubset), std::end(kSubset), made.name()) != std::end(kSubset);
      out.push_back(made);
    }
  return out;
}

std::vector<NamedWorkload> lumibench_motion() {
  return {std::begin(kMotions), std::end(kMotions)};
}

std::vector<NamedWorkload> all_workloads() {
  std::vector<NamedWorkload> out = lumibench();
  out.insert(out.end(), std::begin(kMotions), std::end(kMotions));
  for (const compute::Program& program : compute::all_programs()) out.push_back({program.name, ""});
  return out;
}

std::vector<NamedWorkload> select_workloads(const std::vector<std::string>& names) {
  const std::vector<NamedWorkload> all = all_workloads();
  std::vector<bool> chosen(all.size(), false);
  for (const std::string& name : names) {
    bool found = false;
    for (size_t i = 0; i < all.size(); ++i)
      if (is_called(all[i], upper(name))) chosen[i] = found = true;
    if (found) continue;
    std::vector<std::string> known = {"lumibench", "subset", "lumibench-motion", "compute"};
    for (const std::string_view scene : kScenes) known.emplace_back(scene);
    for (const NamedWorkload& workload : all) known.push_back(workload.name());
    const std::string guess = nearest_in_any_case(name, known);
    throw UserError({}, "there is no workload or suite '" + name + "'",
                    guess.empty() ? "'glint list workloads' and 'glint list programs' name them; suites are "
                                    "lumibench, subset, lumibench-motion and compute"
                                  : "did you mean '" + guess + "'?");
  }
  std::vector<NamedWorkload> out;
  for (size_t i = 0; i < all.size(); ++i)
    if (chosen[i]) out.push_back(all[i]);
  return out;
}

std::optional<SceneAndShader> split_workload(const std::string& name) {
  for (const NamedWorkload& moving : kMotions)
    if (upper(name) == moving.name())
      return SceneAndShader{std::string(moving.scene), std::string(moving.shader),
                            std::string(moving.frames)};
  const size_t bar = name.rfind('_');
  if (bar == std::string::npos) return std::nullopt;
  const std::string scene = upper(name.substr(0, bar)), shader = upper(name.substr(bar + 1));
  for (const scenes::SceneInfo& info : scenes::scene_list())
    for (const WorkloadInfo& set : kWorkloads)
      if (info.name == scene && upper(set.name) == shader)
        return SceneAndShader{scene, std::string(set.name), ""};
  return std::nullopt;
}

}  // namespace glint::app
