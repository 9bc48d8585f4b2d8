// Makes arms of two arms each.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/lab/pairs.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <utility>

#include "base/diagnostics.h"
#include "report/terminal/table.h"
#include "setup/config.h"
#include "setup/oracles.h"
#include "setup/resources.h"

namespace glint::app {
namespace {

constexpr char kJoint = '+';  // between the names of two arms; no arm's own name has it

// Returns what the arm's settings give to each key that they change.
std::map<std::string, std::string> values_of(const setup::Resources& resources, const LabArm& arm) {
  std::map<std::string, std::string> out;
  for (const std::string& setting :
       setup::without_oracles(resources, setup::with_oracles(arm.oracles, arm.settings))) {
    const size_t equals = setting.find('=');
    out[setting.substr(0, equals)] = setting.substr(equals + 1);
  }
  return out;
}

// Returns why the machine of an arm cannot be, or nothing when it can. Only the first message counts, without
// its place.
std::string why_refused(const setup::Resources& resources, const Experiment& experiment, const LabArm& arm) {
  std::vector<std::string> settings = setup::with_oracles(arm.oracles, experiment.settings);
  settings.insert(settings.end(), arm.settings.begin(), arm.settings.end());
  try {
    setup::read_preset(resources, experiment.config, settings);
    return "";
  } catch (const UserError& error) {
    const std::string what = error.what(), mark = "error: ";
    const size_t at = what.find(mark), from = at == std::string::npos ? 0 : at + mark.size();
    return what.substr(from, what.find('\n', from) - from);
  }
}

LabArm both(const LabArm& a, const LabArm& b) {
  LabArm out;
  out.name = a.name + kJoint + b.name;
  out.is_pair = true;
  out.against = a.against;
  out.settings = a.settings;
  out.settings.insert(out.settings.end(), b.settings.begin(), b.settings.end());
  out.oracles = a.oracles;
  out.oracles.insert(out.oracles.end(), b.oracles.begin(), b.oracles.end());
  out.workloads = a.workloads;
  out.ao_reach = a.ao_reach;
  return out;
}

std::string why_not(const setup::Resources& resources, const Experiment& experiment, const LabArm& a,
                    const LabArm& b) {
  const std::map<std::string, std::string> values = values_of(resources, a);
  for (const auto& [key, value] : values_of(resources, b))
    if (const auto other = values.find(key); other != values.end() && other->second != value)
      return fmt::format("both change {}", key);
  return why_refused(resources, experiment, both(a, b));
}

bool is_refused(const std::vector<RefusedPair>& refused, const std::string& first,
                const std::string& second) {
  return std::any_of(refused.begin(), refused.end(),
                     [&](const RefusedPair& pair) { return pair.first == first && pair.second == second; });
}

}  // namespace

std::vector<RefusedPair> add_pairs(const setup::Resources& resources, Experiment& experiment) {
  std::vector<RefusedPair> refused;
  const std::vector<LabArm> single = experiment.arms;
  for (const LabArm& arm : single)
    if (const std::string why = why_refused(resources, experiment, arm); !why.empty())
      throw UserError(fmt::format("the arm '{}' of '{}' is refused: {}", arm.name, experiment.name, why));
  for (auto a = single.begin(); a != single.end(); ++a)
    for (auto b = a + 1; b != single.end(); ++b) {
      const bool is_pair = !a->against.empty() && a->against == b->against && a->workloads == b->workloads &&
                           a->ao_reach == b->ao_reach;
      if (!is_pair) continue;
      if (const std::string why = why_not(resources, experiment, *a, *b); !why.empty())
        refused.push_back({a->name, b->name, why});
      else
        experiment.arms.push_back(both(*a, *b));
    }
  return refused;
}

std::string pair_table(const std::vector<LabResult>& results, const std::vector<RefusedPair>& refused) {
  std::vector<std::string> names;
  std::map<std::string, std::optional<double>> means;
  bool has_pairs = !refused.empty();
  for (const LabResult& result : results) {
    if (result.arm->against.empty()) continue;
    means[result.arm->name] = result.geomean;
    has_pairs |= result.arm->is_pair;
    if (!result.arm->is_pair) names.push_back(result.arm->name);
  }
  if (!has_pairs) return "";
  std::vector<std::vector<std::string>> rows{{"pairs"}};
  rows[0].insert(rows[0].end(), names.begin(), names.end());
  for (size_t i = 0; i < names.size(); ++i) {
    std::vector<std::string> row{names[i]};
    for (size_t j = 0; j < names.size(); ++j) {
      const size_t low = std::min(i, j), high = std::max(i, j);
      const auto found = means.find(i == j ? names[i] : names[low] + kJoint + names[high]);
      const bool is_there = found != means.end() && found->second;
      row.push_back(is_there                                       ? fmt::format("{:.3f}", *found->second)
                    : is_refused(refused, names[low], names[high]) ? "refused"
                                                                   : "-");
    }
    rows.push_back(std::move(row));
  }
  std::string out = "\n" + report::table(rows, "");
  for (const RefusedPair& pair : refused)
    if (means.contains(pair.first) && means.contains(pair.second))
      out += fmt::format("{} and {}: {}\n", pair.first, pair.second, pair.reason);
  return out;
}

}  // namespace glint::app
