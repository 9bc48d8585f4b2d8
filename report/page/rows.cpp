// Turns rows into columns.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/rows.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>
#include <vector>

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

enum Slice : size_t { kThread, kKind, kBegin, kLength };  // places in a row (timeline.cpp)
constexpr size_t kCounts = 8;                             // numbers before the pairs (source.cpp)

}  // namespace

Json timeline_columns(const Json& timeline) {
  std::vector<Json> rows = timeline.at("slices").get<std::vector<Json>>();
  const auto order = [](const Json& row) {
    return std::tuple(row[kKind].get<int64_t>(), row[kThread].get<int64_t>(), row[kBegin].get<int64_t>());
  };
  std::stable_sort(rows.begin(), rows.end(),
                   [&](const Json& a, const Json& b) { return order(a) < order(b); });
  size_t width = 0;
  for (const Json& row : rows) width = std::max(width, row.size());
  std::vector<Json> columns(width, Json::array());
  std::map<std::pair<int64_t, int64_t>, int64_t> ends;
  for (Json& row : rows) {
    const auto [kind, thread, begin] = order(row);
    int64_t& end = ends[{kind, thread}];
    row[kBegin] = begin - end;
    end = begin + row[kLength].get<int64_t>();
    for (size_t i = 0; i < width; ++i) columns[i].push_back(i < row.size() ? row[i] : Json());
  }
  Json out = timeline;
  out["slices"] = columns;
  return out;
}

Json count_columns(const Json& counts) {
  std::vector<Json> columns(kCounts + 1, Json::array());
  for (const Json& row : counts) {
    for (size_t i = 0; i < kCounts; ++i) columns[i].push_back(row[i]);
    columns[kCounts].push_back(std::vector<Json>(row.begin() + kCounts, row.end()));
  }
  return columns;
}

}  // namespace glint::report
