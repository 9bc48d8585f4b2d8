// Draws metrics of frames over the axis of frames.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/frame_bars.h"

#include <algorithm>
#include <cstddef>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "report/page/parts.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

// What a reader asks of frames first: how long each took, how good its structures were, what caches kept.
constexpr const char* kFrameMetrics[] = {"cycles", "avg_nodes_per_ray", "l2_miss_rate", "rt_occupancy"};
constexpr double kFigureWidth = 1000, kLabelWidth = 190;  // in the figure's own units, as all of these
constexpr int kRowHeight = 56, kBarHeight = 40, kNumberHeight = 16;
constexpr double kGapShare = 0.15;  // of a bar's place
constexpr double kNumberRoom = 30;  // from one number of a frame to the next

const Json* metric_doc(const Json& metric_docs, const char* name) {
  for (const Json& doc : metric_docs)
    if (doc["name"] == name) return &doc;
  return nullptr;
}

std::string frame_bar(const Json& point, double x, double width, double height, double bottom,
                      const Json& value, const char* name) {
  return fmt::format(
      "<a href=\"{}\"><rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
      "style=\"fill:var(--blue)\"><title>{}: {} {}</title></rect></a>\n",
      escaped_text(point, "link"), x, bottom - height, width, height, escaped_text(point, "name"), name,
      shown(value));
}

// Returns one row of bars, whose lower edge is at `bottom`. Bars begin at 0.
std::string bar_row(const Json& points, const std::vector<const Json*>& runs, const Json& doc,
                    const char* name, double bottom) {
  std::vector<Json> values;
  double most = 0;
  for (const Json* run : runs) {
    values.push_back(run ? (*run)["metrics"].value(name, Json()) : Json());
    if (values.back().is_number()) most = std::max(most, values.back().get<double>());
  }
  if (most <= 0) return "";
  std::string out = fmt::format(
      "<text x=\"0\" y=\"{:.0f}\" font-size=\"11\" fill=\"currentColor\">{}<title>{}</title></text>\n"
      "<text x=\"0\" y=\"{:.0f}\" font-size=\"9\" fill=\"currentColor\">up to {} {}</text>\n",
      bottom - kBarHeight / 2.0, name, escaped_text(doc, "doc"), bottom - kBarHeight / 2.0 + 13,
      shown(Json(most)), escaped_text(doc, "unit"));
  const double step = (kFigureWidth - kLabelWidth) / double(points.size());
  for (size_t i = 0; i < points.size(); ++i)
    if (values[i].is_number())
      out += frame_bar(points[i], kLabelWidth + step * (double(i) + kGapShare / 2), step * (1 - kGapShare),
                       kBarHeight * values[i].get<double>() / most, bottom, values[i], name);
  return out;
}

// Returns the numbers of the frames below the rows, where there is room.
std::string frame_numbers(const std::vector<const Json*>& runs, double y) {
  const double step = (kFigureWidth - kLabelWidth) / double(runs.size());
  std::string out;
  double last = -kNumberRoom;
  for (size_t i = 0; i < runs.size(); ++i) {
    const double x = kLabelWidth + step * (double(i) + 0.5);
    const Json moment = runs[i] ? (*runs[i])["run"].value("moment", Json::object()) : Json::object();
    if (x - last < kNumberRoom || !moment.contains("frame")) continue;
    last = x;
    out += fmt::format(
        "<text x=\"{:.2f}\" y=\"{:.0f}\" font-size=\"9\" text-anchor=\"middle\" "
        "fill=\"currentColor\">{}</text>\n",
        x, y, moment["frame"].dump());
  }
  return out;
}

}  // namespace

std::string frame_bars(const Json& points, const std::vector<const Json*>& runs, const Json& metric_docs) {
  std::string rows;
  double bottom = 0;
  for (const char* name : kFrameMetrics) {
    const Json* const doc = metric_doc(metric_docs, name);
    const std::string row = doc ? bar_row(points, runs, *doc, name, bottom + kBarHeight) : "";
    if (row.empty()) continue;
    rows += row;
    bottom += kRowHeight;
  }
  if (rows.empty()) return "";
  return fmt::format(
      "<figure data-figure=\"frames\"><svg viewBox=\"0 0 {} {}\" width=\"100%\" role=\"img\" "
      "aria-label=\"Metrics of each frame\">\n{}{}</svg>\n<figcaption class=\"note\">Each bar is a frame, "
      "from the first to the last one, and leads to its own report. Bars begin at 0.</figcaption></figure>\n",
      kFigureWidth, bottom + kNumberHeight, rows, frame_numbers(runs, bottom + kNumberHeight - 4));
}

}  // namespace glint::report
