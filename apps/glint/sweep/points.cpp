// Checks points: the command line of each is parsed as `glint run` would, and its configuration is resolved.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/sweep/points.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <istream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "apps/glint/bench/estimate.h"
#include "apps/glint/bench/plan.h"
#include "apps/glint/bench/workloads.h"
#include "apps/glint/options/image_size.h"
#include "apps/glint/options/output.h"
#include "apps/glint/options/suggest.h"
#include "compute/program.h"
#include "report/files/config_file.h"
#include "scenes/scene.h"
#include "setup/build_commit.h"
#include "setup/config.h"
#include "setup/oracles.h"

namespace glint::app {
namespace {
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Point {
  std::string workload, config = "mobile";
  std::vector<std::string> settings, oracles, options, keys;  // `keys`: whose values are asked for
  bool all_keys = false;

  static Point from(const Json& line) {
    Point out;
    out.workload = line.value("workload", "");
    out.config = line.value("config", out.config);
    out.all_keys = line.value("all_keys", false);
    for (auto& [name, list] : {std::pair{"settings", &out.settings}, std::pair{"oracles", &out.oracles},
                               std::pair{"options", &out.options}, std::pair{"keys", &out.keys}})
      *list = line.value(name, std::vector<std::string>{});
    return out;
  }

  // Returns the value of an option of the form "--size=8x8", or the default.
  std::string value_of(const std::string& option, std::string otherwise) const {
    for (const std::string& word : options)
      if (word.starts_with(option + "=")) otherwise = word.substr(option.size() + 1);
    return otherwise;
  }
};

// Refuses options that `glint run` does not take.
void check_options(const Session& session, const Point& point) {
  Session nested = session;
  CommandLine line("", "glint", GLINT_VERSION);
  add_run(line.command(), nested);
  std::vector<std::string> words = {"glint", "run", point.workload};
  words.insert(words.end(), point.options.begin(), point.options.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  const ParseOutcome outcome = line.parse(int(pointers.size()), pointers.data());
  if (outcome.is_done) throw UserError("--help and --version ask for texts, and a point is a run");
  if (!outcome.error.empty()) throw UserError({}, outcome.error, suggestion(line.command(), words));
  nested.check();
}

// Refuses a workload that is neither a file nor the name of a scene or a program.
void check_workload(const std::string& workload) {
  std::error_code failed;
  if (fs::is_regular_file(workload, failed) || compute::find_program(workload)) return;
  const std::optional<SceneAndShader> named = split_workload(workload);
  const std::string scene = named ? named->scene : workload;
  std::vector<std::string> names;
  for (const scenes::SceneInfo& info : scenes::scene_list()) names.emplace_back(info.name);
  for (const compute::Program& program : compute::all_programs()) names.emplace_back(program.name);
  if (std::find(names.begin(), names.end(), scene) != names.end()) return;
  const std::string guess = nearest(scene.substr(0, scene.rfind('_')), names);
  throw UserError({}, fmt::format("there is neither a file, a scene nor a compute program '{}'", workload),
                  guess.empty() ? "'glint list scenes' and 'glint list programs' name them"
                                : fmt::format("did you mean '{}'?", guess));
}

// Adds the estimates of memory in bytes and of relative time.
void add_estimates(const Point& point, Json& answer) {
  const bool timing = point.value_of("--mode", "timing") == "timing";
  if (const compute::Program* const program = compute::find_program(point.workload)) {
    const bool small = std::ranges::find(point.options, "--small") != point.options.end();
    answer["memory"] = memory_estimate(*program, small);
    answer["weight"] = time_weight(*program, small, timing);
    return;
  }
  scenes::RenderParams frame;
  parse_size(point.value_of("--size", "128x128"), frame);
  parse_crop(point.value_of("--crop", ""), frame);
  const std::optional<SceneAndShader> named = split_workload(point.workload);
  const std::string shader = named ? named->shader : point.value_of("--shader", "pt");
  const NamedWorkload workload{named ? named->scene : point.workload, shader};
  const uint64_t pixels = uint64_t{frame.width} * frame.height;
  const uint64_t samples = std::stoull(point.value_of("--spp", "2"));
  answer["memory"] = memory_estimate(workload, pixels, !point.value_of("--assets", "").empty());
  answer["weight"] = time_weight(workload, timing, pixels, samples);
}

// Returns a number that two configurations share only when all their values are the same: 128 bits, because
// the points of all sweeps of a store are named by it.
std::string name_of(const std::string& values) {
  const std::string backwards(values.rbegin(), values.rend());
  return fmt::format("{:016x}{:016x}", report::fnv1a(values), report::fnv1a(backwards));
}

Json answer_to(const Session& session, const Point& point) {
  Json answer;
  check_workload(point.workload);
  check_options(session, point);
  const std::vector<ParamInfo> infos = describe_params(setup::read_preset(
      session.resources, point.config, setup::with_oracles(point.oracles, point.settings)));
  answer["config"] = name_of(report::config_key_values(infos));
  add_estimates(point, answer);
  for (const ParamInfo& info : infos)
    if (point.all_keys || std::find(point.keys.begin(), point.keys.end(), info.key) != point.keys.end())
      answer["keys"][info.key] = info.value;
  return answer;
}

// Returns the answer to a line, or what is wrong with it.
Json answer_to_line(const Session& session, const std::string& line) {
  try {
    return answer_to(session, Point::from(Json::parse(line)));
  } catch (const Error& error) {
    return {{"error", error.what()}};
  } catch (const nlohmann::json::exception& error) {
    return {{"error", fmt::format("the line is no point: {}", error.what())}};
  } catch (const std::logic_error&) {  // Only --spp is read as a number here, and its rule is checked above.
    return {{"error", "--spp is not a number"}};
  }
}

}  // namespace

void describe_points(const Session& session, std::istream& points) {
  std::vector<std::string_view> programs;
  for (const compute::Program& program : compute::all_programs()) programs.push_back(program.name);
  const Json head = {{"version", GLINT_VERSION},
                     {"git", setup::build_commit()},
                     {"shaders", fmt::format("{:016x}", hash_of_shaders(session.resources))},
                     {"plugins", identity_of(session.plugins)},
                     {"programs", programs},
                     {"available_memory", available_memory()}};
  print_output("{}\n", head.dump());
  // Points of a sweep differ in few things, so that most command lines have been looked at before.
  std::map<std::string, std::string> known;
  for (std::string line; std::getline(points, line);) {
    const auto [at, is_new] = known.try_emplace(line);
    if (is_new) at->second = answer_to_line(session, line).dump() + "\n";
    print_output("{}", at->second);
  }
}

}  // namespace glint::app
