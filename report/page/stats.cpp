// Lays statistics out by path, with the instances of a unit side by side.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/stats.h"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "base/diagnostics.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

// Holds the name of a group as a pattern, and its number. A group of one instance reads "core[3]".
struct Instance {
  std::string pattern;
  size_t index = 0;
  bool is_one = false;
};
Instance instance_of(const std::string& name) {
  const size_t open = name.find('['), close = name.find(']');
  if (open == std::string::npos || close == std::string::npos || close <= open + 1) return {name};
  const std::string digits = name.substr(open + 1, close - open - 1);
  if (digits.size() > 6 || digits.find_first_not_of("0123456789") != std::string::npos) return {name};
  return {name.substr(0, open + 1) + "*" + name.substr(close), std::stoul(digits), true};
}

class Turner {
 public:
  Turner(Json& out, Json& docs) : out_(out), docs_(docs) {}

  void walk(const Json& group, const std::string& path, size_t index) {
    for (const auto& [name, child] : group.items()) {
      if (!child.is_object()) continue;
      const Instance instance = instance_of(name);
      const std::string there = path.empty() ? instance.pattern : path + "." + instance.pattern;
      const size_t number = instance.is_one ? instance.index : index;
      if (child.contains("value") && child.contains("unit"))
        add(child, there, number);
      else
        walk(child, there, number);
    }
  }

 private:
  void add(const Json& stat, const std::string& path, size_t index) {
    if (!docs_.contains(path)) {
      docs_[path] = stat;
      docs_[path].erase("value");
    }
    const Json& value = stat["value"];
    if (value.is_object()) {
      for (const auto& [part, count] : value.items()) put(path + "::" + part, index, count);
    } else if (value.is_array()) {
      Json bins = value;
      while (!bins.empty() && bins.back() == 0) bins.erase(bins.size() - 1);
      put(path, index, std::move(bins));
    } else {
      put(path, index, value);
    }
  }
  void put(const std::string& path, size_t index, Json value) {
    const bool is_known =
        value.is_number() || (value.is_array() && std::all_of(value.begin(), value.end(),
                                                              [](const Json& v) { return v.is_number(); }));
    if (!is_known)
      throw UserError({}, fmt::format("the statistic '{}' has no number", path),
                      "stats.json is damaged; run it again");
    Json& list = out_[path];
    if (list.is_null()) list = Json::array();
    while (list.size() <= index) list.push_back(0);
    list[index] = std::move(value);
  }

  Json& out_;
  Json& docs_;
};

bool is_all_zero(const Json& list) {
  for (const Json& value : list)
    if (!value.is_number() || value != 0) return false;
  return true;
}

}  // namespace

nlohmann::ordered_json page_stats(const nlohmann::ordered_json& stats, nlohmann::ordered_json& docs) {
  Json out = Json::object();
  Turner(out, docs).walk(stats, "", 0);
  for (auto& [path, list] : out.items())
    if (is_all_zero(list)) list = 0;
  return out;
}

}  // namespace glint::report
