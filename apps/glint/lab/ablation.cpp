// Finds the differences of two configurations and makes the machines between them.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/lab/ablation.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <set>

#include "apps/glint/bench/tables.h"
#include "base/diagnostics.h"
#include "report/files/run_record.h"
#include "report/metrics/metrics.h"
#include "setup/config.h"

namespace glint::app {
namespace {

std::vector<ParamInfo> keys_of(const setup::Resources& resources, const std::string& config) {
  return describe_params(setup::read_preset(resources, config));
}

// Returns the group of a key: the key itself in a table at the top, else the first two parts of its name.
std::string group_of(const std::string& key, bool by_key) {
  const size_t first = key.find('.'), second = first == std::string::npos ? first : key.find('.', first + 1);
  return by_key || second == std::string::npos ? key : key.substr(0, second);
}

bool is_wanted(const std::string& key, const std::vector<std::string>& only) {
  return only.empty() ||
         std::ranges::any_of(only, [&](const std::string& start) { return key.starts_with(start); });
}

std::string unquoted(std::string value) {
  std::erase(value, '"');
  return value;
}

std::vector<AblationGroup> differences(const setup::Resources& resources, const AblationOptions& options) {
  std::map<std::string, std::string> before;
  for (const ParamInfo& param : keys_of(resources, options.from)) before[param.key] = param.value;
  std::vector<AblationGroup> out;
  std::map<std::string, std::string> needs;  // the choice that a key belongs to, in the first configuration
  for (const ParamInfo& param : keys_of(resources, options.from))
    if (!param.needs.empty()) needs[param.key] = param.needs.substr(0, param.needs.find_first_of(" ="));
  for (const ParamInfo& param : keys_of(resources, options.to)) {
    if (!param.needs.empty() || !is_wanted(param.key, options.only)) continue;
    if (const auto old = before.find(param.key); old != before.end() && old->second == param.value) continue;
    const auto choice = needs.find(param.key);
    const std::string name = group_of(choice == needs.end() ? param.key : choice->second, options.by_key);
    auto group = std::ranges::find_if(out, [&](const AblationGroup& one) { return one.name == name; });
    if (group == out.end()) group = out.insert(out.end(), {name, {}});
    group->settings.push_back(param.key + "=" + unquoted(param.value));
  }
  return out;
}

void put_first(const std::vector<std::string>& order, std::vector<AblationGroup>& groups) {
  for (auto name = order.rbegin(); name != order.rend(); ++name) {
    const auto found =
        std::ranges::find_if(groups, [&](const AblationGroup& group) { return group.name == *name; });
    if (found == groups.end()) {
      std::vector<std::string> names;
      for (const AblationGroup& group : groups) names.push_back(group.name);
      const std::string guess = nearest(*name, names);
      throw UserError({}, fmt::format("the configurations do not differ in a group '{}'", *name),
                      guess.empty() ? fmt::format("they differ in {}", fmt::join(names, ", "))
                                    : "did you mean '" + guess + "'?");
    }
    std::rotate(groups.begin(), found, found + 1);
  }
}

// Returns the settings of the groups that are chosen, in order.
std::vector<std::string> settings_of(const std::vector<AblationGroup>& groups,
                                     const std::vector<bool>& chosen) {
  std::vector<std::string> out;
  for (size_t i = 0; i < groups.size(); ++i)
    if (chosen[i]) out.insert(out.end(), groups[i].settings.begin(), groups[i].settings.end());
  return out;
}

std::string why_refused(const setup::Resources& resources, const std::string& config,
                        const std::vector<std::string>& settings) {
  try {
    setup::read_preset(resources, config, settings);
    return "";
  } catch (const UserError& error) {
    const std::string what = error.what();
    return what.substr(0, what.find('\n'));
  }
}

// Adds arms, and gives those with the same machine one folder.
class ArmMaker {
 public:
  ArmMaker(const setup::Resources& resources, Ablation& ablation)
      : resources_(resources), ablation_(ablation) {}

  void add(AblationKind kind, size_t group, const std::string& name, const std::vector<bool>& chosen) {
    AblationArm arm{kind, group, name, settings_of(ablation_.groups, chosen), ""};
    if (const auto known = folders_.find(chosen); known != folders_.end())
      arm.folder = known->second.first, arm.refused = known->second.second;
    else
      arm.refused = why_refused(resources_, ablation_.options.from, arm.settings);
    folders_.try_emplace(chosen, arm.folder, arm.refused);
    ablation_.arms.push_back(std::move(arm));
  }

 private:
  const setup::Resources& resources_;
  Ablation& ablation_;
  std::map<std::vector<bool>, std::pair<std::string, std::string>> folders_;
};

double mean_of(const std::vector<double>& values, bool is_geometric) {
  double sum = 0;
  for (const double value : values) sum += is_geometric ? std::log(value) : value;
  const double mean = sum / double(values.size());
  return is_geometric ? std::exp(mean) : mean;
}

}  // namespace

const AblationArm* Ablation::find(AblationKind kind, size_t group) const {
  const auto found = std::ranges::find_if(
      arms, [&](const AblationArm& arm) { return arm.kind == kind && arm.group == group; });
  return found == arms.end() ? nullptr : &*found;
}

Ablation plan_ablation(const setup::Resources& resources, const AblationOptions& options) {
  Ablation out{options, differences(resources, options), {}};
  if (out.groups.empty())
    throw UserError({}, fmt::format("'{}' and '{}' do not differ{}", options.from, options.to,
                                    options.only.empty() ? "" : " in what --only names"));
  put_first(options.order, out.groups);
  const size_t count = out.groups.size();
  ArmMaker maker(resources, out);
  maker.add(AblationKind::From, 0, "from", std::vector<bool>(count, false));
  maker.add(AblationKind::To, 0, "to", std::vector<bool>(count, true));
  for (size_t i = 0; i < count; ++i) {
    std::vector<bool> alone(count, false), back(count, true), step(count, false);
    alone[i] = true, back[i] = false;
    std::fill(step.begin(), step.begin() + ptrdiff_t(i) + 1, true);
    const std::string& name = out.groups[i].name;
    if (options.alone) maker.add(AblationKind::Alone, i, "alone-" + name, alone);
    if (options.back) maker.add(AblationKind::Back, i, "without-" + name, back);
    if (options.steps) maker.add(AblationKind::Step, i, fmt::format("step-{:02}-{}", i + 1, name), step);
  }
  for (const AblationKind end : {AblationKind::From, AblationKind::To})
    if (const AblationArm& arm = *out.find(end); !arm.refused.empty())
      throw UserError({}, "one of the two machines is refused: " + arm.refused);
  return out;
}

AblationMeans read_means(const Ablation& ablation, const std::string& folder) {
  AblationMeans out;
  for (const AblationArm& arm : ablation.arms) {
    if (!arm.refused.empty() || out.contains(arm.folder)) continue;
    std::map<std::string, std::vector<double>> values;
    for (const auto& [workload, directory] : finished_runs(folder + "/" + arm.folder))
      for (const report::MetricValue& metric : report::metrics_of(report::RunRecord::read(directory)))
        if (metric.value) values[std::string(metric.metric->name)].push_back(*metric.value);
    for (const auto& [metric, all] : values) out[arm.folder][metric] = mean_of(all, metric == "cycles");
  }
  return out;
}

std::optional<double> effect_of(const Ablation& ablation, const AblationMeans& means,
                                const std::string& metric, AblationKind kind, size_t group) {
  const auto value = [&](const AblationArm* arm) -> std::optional<double> {
    if (!arm || !arm->refused.empty() || !means.contains(arm->folder)) return std::nullopt;
    const auto& of_arm = means.at(arm->folder);
    const auto found = of_arm.find(metric);
    return found == of_arm.end() ? std::nullopt : std::optional(found->second);
  };
  const std::optional<double> mine = value(ablation.find(kind, group));
  if (!mine) return std::nullopt;
  if (kind == AblationKind::Back) {
    const std::optional<double> whole = value(ablation.find(AblationKind::To));
    return whole ? std::optional(*whole - *mine) : std::nullopt;
  }
  // A step whose predecessor is refused counts from the last one that is not.
  for (size_t before = group; kind == AblationKind::Step && before-- > 0;)
    if (const auto earlier = value(ablation.find(kind, before))) return *mine - *earlier;
  const std::optional<double> base = value(ablation.find(AblationKind::From));
  return base ? std::optional(*mine - *base) : std::nullopt;
}

}  // namespace glint::app
