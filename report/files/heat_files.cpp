// Summarises, lists and reads maps of cost.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/heat_files.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/diagnostics.h"
#include "report/picture/npy.h"

namespace glint::report {
namespace {

constexpr int kMapsSchema = 1;  // schema of maps.json

}  // namespace

HeatSummary summary_of(const CostMap& map) {
  HeatSummary out;
  if (map.values.empty()) return out;
  std::vector<double> values = map.values;
  for (const double value : values) out.sum += value;
  const size_t rank = size_t(std::ceil(0.99 * double(values.size()))) - 1;  // nearest rank
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(rank), values.end());
  out.p99 = values[rank];
  const auto [low, high] = std::minmax_element(map.values.begin(), map.values.end());
  out.min = *low;
  out.max = *high;
  out.mean = out.sum / double(values.size());
  out.top = out.p99 > 0 ? out.p99 : out.max;
  return out;
}

std::string heat_index(const std::vector<CostMap>& maps) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const CostMap& map : maps) {
    const HeatSummary s = summary_of(map);
    list.push_back({{"name", map.name},
                    {"unit", map.unit},
                    {"doc", map.doc},
                    {"file", map.name + ".npy"},
                    {"picture", map.name + ".png"},
                    {"width", map.width},
                    {"height", map.height},
                    {"sum", s.sum},
                    {"min", s.min},
                    {"mean", s.mean},
                    {"p99", s.p99},
                    {"max", s.max}});
  }
  return nlohmann::ordered_json{{"schema", kMapsSchema}, {"maps", list}}.dump(1) + "\n";
}

std::vector<std::pair<std::string, std::string>> heat_files(const std::vector<CostMap>& maps) {
  // The index comes first, because it tells the next run which files to remove, even when this one is killed.
  std::vector<std::pair<std::string, std::string>> files = {{"heat/maps.json", heat_index(maps)}};
  for (const CostMap& map : maps) {
    files.emplace_back("heat/" + map.name + ".npy", npy_of_map(map));
    files.emplace_back("heat/" + map.name + ".png", heat_png(map));
  }
  return files;
}

std::vector<CostMap> read_heat(const ListedFiles& files) {
  const std::string path = files.path_of("heat/maps.json");
  std::vector<CostMap> maps;
  const std::optional<std::string> text = files.read("heat/maps.json");
  if (!text) return maps;
  const auto index = nlohmann::json::parse(*text, nullptr, false);
  if (!index.is_object() || index.value("schema", 0) != kMapsSchema || !index.contains("maps"))
    throw UserError({path}, "this is not a list of maps that this version knows", "run it again");
  for (const auto& entry : index["maps"]) {
    if (!entry.is_object()) throw UserError({path}, "an element of 'maps' is no map", "run it again");
    CostMap map{entry.value("name", ""), entry.value("unit", ""), entry.value("doc", ""), true, 0, 0, {}};
    const std::string file = "heat/" + entry.value("file", "");
    read_npy(files.need(file), files.path_of(file), map);
    maps.push_back(std::move(map));
  }
  return maps;
}

}  // namespace glint::report
