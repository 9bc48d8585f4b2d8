// Compares two runs by their metrics.
// SPDX-License-Identifier: Apache-2.0
#include "report/metrics/compare.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "base/diagnostics.h"

namespace glint::report {
namespace {

constexpr std::string_view kOfTheHost = "sim_rate";

// Returns the distance by which changes are sorted. A value that came from 0 is the furthest.
double distance(const Change& c) {
  return c.relative ? std::abs(*c.relative) : std::numeric_limits<double>::infinity();
}

std::string relative_text(const Change& c) {
  if (!c.relative) return "new";
  return *c.relative == 0 ? "=" : fmt::format("{:+.2f} %", 100 * *c.relative);
}

std::vector<std::string> metric_names() {
  std::vector<std::string> names;
  for (const MetricGroup& group : metric_groups())
    for (const Metric& metric : group.metrics) names.emplace_back(metric.name);
  return names;
}

}  // namespace

std::vector<Change> changes(const RunRecord& before, const RunRecord& after) {
  const std::vector<MetricValue> was = metrics_of(before), is = metrics_of(after);
  std::vector<Change> out;
  for (size_t i = 0; i < was.size(); ++i) {
    if (!was[i].value || !is[i].value || was[i].metric->name == kOfTheHost) continue;
    Change change{was[i].metric, *was[i].value, *is[i].value, std::nullopt};
    if (change.before == change.after)
      change.relative = 0;
    else if (change.before != 0)
      change.relative = change.after / change.before - 1;
    out.push_back(change);
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Change& a, const Change& b) { return distance(a) > distance(b); });
  return out;
}

std::string uncompared_text(const RunRecord& before, const RunRecord& after) {
  const std::vector<MetricValue> was = metrics_of(before), is = metrics_of(after);
  const auto line = [&](const std::vector<MetricValue>& one, const std::vector<MetricValue>& other,
                        std::string_view run) {
    std::string names;
    size_t count = 0;
    for (size_t i = 0; i < one.size(); ++i) {
      if (!one[i].value || other[i].value || one[i].metric->name == kOfTheHost) continue;
      names += fmt::format("{}{}", count++ ? ", " : "", one[i].metric->name);
    }
    return count ? fmt::format("{} metrics are only in {}: {}\n", count, run, names) : "";
  };
  return line(was, is, "A") + line(is, was, "B");
}

std::string different_work(const RunRecord& before, const RunRecord& after) {
  std::set<std::string> overrides;
  for (const RunRecord* run : {&before, &after})
    for (const auto& [key, value] : run->texts_in("overrides")) overrides.insert("overrides." + key);
  std::vector<std::string> facts = {"scene.name",
                                    "scene.hash",
                                    "shader",
                                    "width",
                                    "height",
                                    "crop.x",
                                    "crop.y",
                                    "crop.frame_width",
                                    "crop.frame_height",
                                    "samples",
                                    "seed",
                                    "rays.bounces",
                                    "mode",
                                    "rays.shadow_rays",
                                    "rays.ao_rays",
                                    "rays.ao_reach"};
  facts.insert(facts.end(), overrides.begin(), overrides.end());
  std::string out;
  for (const std::string& fact : facts) {
    const auto value = [&](const RunRecord& run) {
      const std::optional<double> number = run.fact(fact);
      const std::string text = number ? fmt::format("{}", *number) : run.text(fact);
      return text.empty() ? "nothing" : text;
    };
    if (const std::string was = value(before), is = value(after); was != is)
      out += fmt::format("{}{} is {} in A and {} in B", out.empty() ? "" : "; ", fact, was, is);
  }
  return out;
}

Condition parse_condition(const std::string& text) {
  const size_t sign = text.find_first_of("<>");
  const std::string note = "expected METRIC<-2% or METRIC>5%: a change in percent";
  if (sign == std::string::npos || sign == 0 || text.back() != '%')
    throw UserError({}, fmt::format("'{}' is not a condition", text), note);
  Condition out{.text = text, .metric = text.substr(0, sign), .below = text[sign] == '<', .percent = 0};
  const char* first = text.data() + sign + 1;
  const char* last = text.data() + text.size() - 1;
  if (first < last && *first == '+') ++first;
  const auto [end, error] = std::from_chars(first, last, out.percent);
  if (error != std::errc{} || end != last || !std::isfinite(out.percent))
    throw UserError({}, fmt::format("'{}' is not a condition", text), note);
  const std::vector<std::string> names = metric_names();
  if (std::find(names.begin(), names.end(), out.metric) == names.end()) {
    const std::string guess = nearest(out.metric, names);
    throw UserError(
        {}, fmt::format("there is no metric '{}'", out.metric),
        guess.empty() ? "`glint list metrics` names them" : fmt::format("did you mean '{}'?", guess));
  }
  return out;
}

bool holds(const Condition& condition, const std::vector<Change>& changes) {
  const auto found = std::find_if(changes.begin(), changes.end(),
                                  [&](const Change& c) { return c.metric->name == condition.metric; });
  if (found == changes.end())
    throw UserError({}, fmt::format("'{}' cannot be checked: one of the runs has no {}", condition.text,
                                    condition.metric));
  const double percent = found->relative
                             ? 100 * *found->relative
                             : std::copysign(std::numeric_limits<double>::infinity(), found->after);
  return condition.below ? percent < condition.percent : percent > condition.percent;
}

std::string changes_text(const std::vector<Change>& changes, bool all) {
  std::vector<std::vector<std::string>> rows;
  for (const Change& c : changes)
    if (all || c.before != c.after)
      rows.push_back({std::string(c.metric->name), fmt::format("{:.6g}", c.before),
                      fmt::format("{:.6g}", c.after), relative_text(c), std::string(c.metric->unit)});
  return rows.empty() ? fmt::format("all {} metrics are equal\n", changes.size()) : table(rows, "<>>><");
}

}  // namespace glint::report
