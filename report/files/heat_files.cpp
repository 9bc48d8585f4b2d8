// Summarises, lists and reads maps of cost.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/heat_files.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/diagnostics.h"
#include "report/picture/npy.h"

namespace glint::report {
namespace {

constexpr int kMapsSchema = 1;  // schema of maps.json

std::string read_whole(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw UserError({path}, "cannot read the file", "the run's maps are incomplete; run it again");
  return {std::istreambuf_iterator<char>(in), {}};
}

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

std::vector<CostMap> read_heat(const std::string& directory) {
  const std::string path = directory + "/heat/maps.json";
  std::vector<CostMap> maps;
  if (!std::filesystem::exists(path)) return maps;
  const auto index = nlohmann::json::parse(read_whole(path), nullptr, false);
  if (!index.is_object() || index.value("schema", 0) != kMapsSchema || !index.contains("maps"))
    throw UserError({path}, "this is not a list of maps that this version knows", "run it again");
  for (const auto& entry : index["maps"]) {
    CostMap map{entry.value("name", ""), entry.value("unit", ""), entry.value("doc", ""), true, 0, 0, {}};
    const std::string file = directory + "/heat/" + entry.value("file", "");
    read_npy(read_whole(file), file, map);
    maps.push_back(std::move(map));
  }
  return maps;
}

}  // namespace glint::report
