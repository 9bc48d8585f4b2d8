// Knows which keys make an oracle.
// SPDX-License-Identifier: Apache-2.0
#include "setup/oracles.h"

#include <algorithm>
#include <fmt/format.h>
#include <string_view>

#include "base/diagnostics.h"
#include "base/params.h"
#include "setup/config.h"

namespace glint::setup {
namespace {

constexpr std::string_view kKey = "oracle=";
constexpr const char* kIdealMemory = "ideal-memory";  // the preset whose memory the oracle takes

struct Oracle {
  std::string name, doc;
  std::vector<std::string> settings;
  bool takes_memory = false;  // and all keys under `memory` of the preset kIdealMemory
};

// docs/lab.md defines each of them exactly.
const std::vector<Oracle>& oracles() {
  static const std::vector<Oracle> all = {
      {"perfect_prefetch", "Every node is in the L1 when a ray asks for it.", {"rt.oracle.fetch_hits=true"}},
      {"perfect_prediction", "A ray with a hit begins at the leaf that has it.", {"rt.entry=perfect"}},
      {"no_divergence",
       "A lane without a ray takes one of another warp, or part of another lane's walk.",
       {"rt.oracle.any_lane=true", "rt.mapping=cooperative", "rt.cooperative.moves=32"}},
      {"infinite_tests",
       "Every test of a node starts at once and takes a cycle.",
       {"rt.box.latency=1", "rt.box.interval=1", "rt.box.units=4096", "rt.triangle.latency=1",
        "rt.triangle.interval=1", "rt.triangle.units=4096", "rt.transform.latency=1",
        "rt.transform.interval=1", "rt.transform.units=4096"}},
      {"ideal_memory", "Memory costs next to nothing, as in the preset ideal-memory.", {}, true}};
  return all;
}

std::vector<std::string> names() {
  std::vector<std::string> out;
  for (const Oracle& oracle : oracles()) out.push_back(oracle.name);
  return out;
}

std::vector<std::string> settings_of(const Resources& resources, const std::string& name) {
  const auto found = std::find_if(oracles().begin(), oracles().end(),
                                  [&](const Oracle& oracle) { return oracle.name == name; });
  if (found == oracles().end()) {
    const std::string guess = nearest(name, names());
    throw UserError({}, fmt::format("there is no oracle '{}'; there are {}", name, fmt::join(names(), ", ")),
                    guess.empty() ? "" : fmt::format("did you mean '{}'?", guess));
  }
  std::vector<std::string> out = found->settings;
  if (found->takes_memory)
    for (const ParamInfo& info : describe_params(read_preset(resources, kIdealMemory)))
      if (info.key.rfind("memory.", 0) == 0) out.push_back(info.key + "=" + info.value);
  return out;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> oracle_list() {
  std::vector<std::pair<std::string, std::string>> out;
  for (const Oracle& oracle : oracles()) out.emplace_back(oracle.name, oracle.doc);
  return out;
}

std::vector<std::string> with_oracles(const std::vector<std::string>& names,
                                      const std::vector<std::string>& settings) {
  std::vector<std::string> out;
  for (const std::string& name : names) out.push_back(std::string(kKey) + name);
  out.insert(out.end(), settings.begin(), settings.end());
  return out;
}

std::vector<std::string> without_oracles(const Resources& resources,
                                         const std::vector<std::string>& settings) {
  std::vector<std::string> out;
  for (const std::string& setting : settings) {
    if (setting.rfind(kKey, 0) != 0) {
      out.push_back(setting);
      continue;
    }
    const std::vector<std::string> own = settings_of(resources, setting.substr(kKey.size()));
    out.insert(out.end(), own.begin(), own.end());
  }
  return out;
}

}  // namespace glint::setup
