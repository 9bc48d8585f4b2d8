// Writes an ablation as a table, as CSV, and as a page of waterfalls.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "apps/glint/lab/ablation.h"
#include "report/files/csv_field.h"
#include "report/terminal/table.h"

namespace glint::app {
namespace {

// Returns a number with four digits, however large or small it is.
std::string digits_of(double value) {
  return std::abs(value) >= 1e4 ? report::with_thousands(uint64_t(std::llround(std::abs(value))))
                                : fmt::format("{:.4g}", std::abs(value));
}

std::string change_text(const std::optional<double>& value) {
  if (!value) return "-";
  return (*value < 0 ? "-" : "+") + digits_of(*value);
}

std::optional<double> mean(const AblationMeans& means, const std::string& folder, const std::string& metric) {
  const auto of_arm = means.find(folder);
  if (of_arm == means.end() || !of_arm->second.contains(metric)) return std::nullopt;
  return of_arm->second.at(metric);
}

std::string_view name_of(AblationKind kind) {
  constexpr std::string_view kNames[] = {"from", "to", "alone", "back", "step"};
  return kNames[size_t(kind)];
}

// Draws the value of the first machine, a bar for each step from its value before to that after, and the
// value of the second machine.
class Waterfall {
 public:
  Waterfall(double from, double to)
      : from_(from), to_(to), low_(std::min({0.0, from, to})), high_(std::max(from, to)) {}

  void add(const std::string& name, double step) {
    bars_.push_back({name, at_, at_ + step, step < 0 ? "#b5482f" : "#2f6fb5"});
    at_ += step;
    low_ = std::min(low_, at_), high_ = std::max(high_, at_);
  }

  std::string svg(const std::string& from_name, const std::string& to_name) {
    std::vector<Bar> all = {{from_name, 0, from_, "#777"}};
    for (const Bar& bar : bars_) all.push_back({bar.name, from_ + bar.begin, from_ + bar.end, bar.colour});
    all.push_back({to_name, 0, to_, "#777"});
    low_ = std::min(low_, from_ + low_), high_ = std::max(high_, from_ + high_);
    std::string out = fmt::format("<svg viewBox='0 0 900 {}' role='img'>\n", all.size() * kRow + 4);
    for (size_t i = 0; i < all.size(); ++i) out += row(all[i], i * kRow);
    return out + "</svg>\n";
  }

 private:
  static constexpr size_t kRow = 20;
  struct Bar {
    std::string name;
    double begin, end;
    const char* colour;
  };

  double x(double value) const { return 220 + 560 * (value - low_) / std::max(high_ - low_, 1e-300); }

  std::string row(const Bar& bar, size_t y) const {
    const double left = x(std::min(bar.begin, bar.end)), right = x(std::max(bar.begin, bar.end));
    const bool is_whole = bar.begin == 0 && std::string_view(bar.colour) == "#777";
    const std::string text = is_whole ? digits_of(bar.end) : change_text(bar.end - bar.begin);
    return fmt::format(
        "<text x='210' y='{0}' text-anchor='end'>{1}</text><rect x='{2:.1f}' y='{3}' width='{4:.1f}' "
        "height='14' fill='{5}'/><text x='{6:.1f}' y='{0}'>{7}</text>\n",
        y + 14, bar.name, left, y + 3, std::max(right - left, 1.0), bar.colour, right + 5, text);
  }

  double from_, to_, low_, high_, at_ = 0;
  std::vector<Bar> bars_;
};

}  // namespace

std::string ablation_table(const Ablation& ablation, const AblationMeans& means,
                           const std::vector<std::string>& metrics) {
  std::string out;
  for (const std::string& metric : metrics) {
    const std::optional<double> from = mean(means, "from", metric), to = mean(means, "to", metric);
    if (!from || !to) continue;
    std::vector<std::vector<std::string>> rows = {{metric, "alone", "back", "step"}};
    for (size_t i = 0; i < ablation.groups.size(); ++i) {
      rows.push_back({ablation.groups[i].name});
      for (const AblationKind kind : {AblationKind::Alone, AblationKind::Back, AblationKind::Step}) {
        const AblationArm* arm = ablation.find(kind, i);
        rows.back().push_back(arm && !arm->refused.empty()
                                  ? "refused"
                                  : change_text(effect_of(ablation, means, metric, kind, i)));
      }
    }
    out += fmt::format("{}: {} on {}, {} on {}\n{}\n", metric, digits_of(*from), ablation.options.from,
                       digits_of(*to), ablation.options.to, report::table(rows, "<>>>"));
  }
  for (const AblationArm& arm : ablation.arms)
    if (!arm.refused.empty()) out += fmt::format("{} is refused: {}\n", arm.folder, arm.refused);
  return out;
}

std::string ablation_csv(const Ablation& ablation, const AblationMeans& means) {
  std::string out = "arm,kind,group,metric,mean\n";
  for (const AblationArm& arm : ablation.arms) {
    const auto found = means.find(arm.folder);
    if (found == means.end()) continue;
    const bool has_group = arm.kind != AblationKind::From && arm.kind != AblationKind::To;
    for (const auto& [metric, value] : found->second)
      out += fmt::format("{},{},{},{},{}\n", report::csv_field(arm.folder), name_of(arm.kind),
                         has_group ? report::csv_field(ablation.groups[arm.group].name) : "",
                         report::csv_field(metric), value);
  }
  return out;
}

std::string ablation_page(const Ablation& ablation, const AblationMeans& means,
                          const std::vector<std::string>& metrics) {
  std::string out = fmt::format(
      "<!DOCTYPE html><html lang='en'><meta charset='utf-8'><title>{0} to {1}</title><style>body{{font:14px "
      "sans-serif;max-width:60em;margin:2em auto}}svg{{font:12px sans-serif}}</style>\n<h1>From {0} to "
      "{1}</h1>"
      "<p>Each bar is what a group of keys changes when it comes on top of those above it. A step that no "
      "machine can have is part of the next one.</p>\n",
      ablation.options.from, ablation.options.to);
  for (const std::string& metric : metrics) {
    const std::optional<double> from = mean(means, "from", metric), to = mean(means, "to", metric);
    if (!from || !to) continue;
    Waterfall waterfall(*from, *to);
    for (size_t i = 0; i < ablation.groups.size(); ++i)
      if (const auto step = effect_of(ablation, means, metric, AblationKind::Step, i))
        waterfall.add(ablation.groups[i].name, *step);
    out += fmt::format("<h2 id='{0}'>{0}</h2>\n{1}", metric,
                       waterfall.svg(ablation.options.from, ablation.options.to));
  }
  return out + "</html>\n";
}

}  // namespace glint::app
