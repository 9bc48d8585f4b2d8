// Turns the runs of a document into columns, and finds the columns that others give.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/columns.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "report/page/rows.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

// This many numbers of statistics take 2 to 3 bytes each. With more, a page would not stay below 1 MB.
constexpr size_t kMaxNumbers = 200'000;
constexpr double kMaxWhole = 9007199254740992.0;  // 2^53; from there on a double is not an exact count

// Writes 5.0 as 5, at any depth.
Json whole(const Json& value) {
  if (value.is_array()) {
    Json out = Json::array();
    for (const Json& one : value) out.push_back(whole(one));
    return out;
  }
  if (!value.is_number_float()) return value;
  const double number = value.get<double>();
  return std::floor(number) == number && std::abs(number) < kMaxWhole ? Json(int64_t(number)) : value;
}

size_t numbers_in(const Json& value) {
  size_t out = 0;
  for (const Json& one : value) out += one.is_array() ? one.size() : 1;
  return out;
}

bool is_fraction(const Json& value) {
  return value.is_number_float() ||
         (value.is_array() && std::any_of(value.begin(), value.end(), is_fraction));
}

// Adds up counts over all instances, and those of a histogram bin by bin: [1, 2] becomes [3], and [[1, 2],
// [1]] becomes [[2, 2]].
Json added_up(const Json& instances) {
  if (!instances.is_array() || instances.size() < 2) return instances;
  const bool is_histogram =
      std::any_of(instances.begin(), instances.end(), [](const Json& one) { return one.is_array(); });
  std::vector<int64_t> sums(is_histogram ? 0 : 1);
  for (const Json& one : instances) {
    const Json bins = one.is_array() ? one : is_histogram ? Json::array() : Json::array({one});
    if (bins.size() > sums.size()) sums.resize(bins.size());
    for (size_t i = 0; i < bins.size(); ++i) sums[i] += bins[i].get<int64_t>();
  }
  return is_histogram ? Json::array({sums}) : Json(sums);
}

class Columns {
 public:
  explicit Columns(size_t num_runs) : num_runs_(num_runs) {}

  // Adds the values of a run. A name that the first runs lack comes behind the name that it follows in its
  // own run.
  void add(size_t run, const Json& values) {
    auto next = names_.begin();
    for (const auto& [name, value] : values.items()) {
      auto found = columns_.find(name);
      if (found == columns_.end())
        found = columns_.emplace(name, Column{names_.insert(next, name), std::vector<Json>(num_runs_)}).first;
      next = std::next(found->second.place);
      found->second.values[run] = whole(value);
    }
  }
  size_t num_numbers() const {
    size_t out = 0;
    for (const auto& [name, column] : columns_)
      for (const Json& value : column.values) out += numbers_in(value);
    return out;
  }

  // Replaces each count by its sum over the instances. Fractions and means of an instance have no sum and are
  // removed.
  void add_up() {
    for (auto name = names_.begin(); name != names_.end();) {
      std::vector<Json>& values = columns_.at(*name).values;
      const bool is_many = std::any_of(values.begin(), values.end(),
                                       [](const Json& one) { return one.is_array() && one.size() > 1; });
      if (is_many && std::any_of(values.begin(), values.end(), is_fraction)) {
        columns_.erase(*name);
        name = names_.erase(name);
        continue;
      }
      for (Json& value : values) value = added_up(value);
      ++name;
    }
  }

  const std::list<std::string>& names() const { return names_; }
  const std::vector<Json>& values(const std::string& name) const { return columns_.at(name).values; }

  // Returns {name: column} of all columns except those in `left_out`.
  Json json(const Json& left_out = Json::object()) const {
    Json out = Json::object();
    for (const std::string& name : names_) {
      if (left_out.contains(name)) continue;
      const std::vector<Json>& all = values(name);
      const bool is_same =
          std::all_of(all.begin(), all.end(), [&](const Json& one) { return one == all[0]; });
      out[name] = is_same ? Json::array({all[0]}) : Json(all);
    }
    return out;
  }

 private:
  struct Column {
    std::list<std::string>::iterator place;
    std::vector<Json> values;
  };
  size_t num_runs_;
  std::list<std::string> names_;
  std::unordered_map<std::string, Column> columns_;
};

// Holds the instances of a run: none when it lacks the statistic, and {0} when all are 0, as page_stats() has
// it.
using Instances = std::vector<double>;
struct WantedNumbers {
  std::string name;
  std::vector<Instances> runs;
  bool is_whole = true;
};

std::optional<WantedNumbers> numbers_of(const std::string& name, const std::vector<Json>& values) {
  WantedNumbers out{name, {}, true};
  for (const Json& value : values) {
    Instances& instances = out.runs.emplace_back();
    if (value.is_null()) continue;
    const Json list = value.is_array() ? value : Json::array({value});
    for (const Json& one : list) {
      if (!one.is_number()) return std::nullopt;  // histograms have lists
      instances.push_back(one.get<double>());
      out.is_whole &= !one.is_number_float();
    }
  }
  return out;
}

double at(const Instances& instances, size_t index) {
  return instances[instances.size() == 1 ? 0 : index];
}

// Computes quotients as web/src/document.js does, where a division by 0 gives 0.
bool is_quotient(const Instances& wanted, const Instances& over, const Instances& under) {
  if (over.empty() || under.empty()) return wanted.empty();
  const size_t size = std::max(over.size(), under.size());
  if ((over.size() != size && over.size() != 1) || (under.size() != size && under.size() != 1)) return false;
  if (wanted.size() != size && !(wanted.size() == 1 && wanted[0] == 0)) return false;
  for (size_t i = 0; i < size; ++i)
    if ((at(under, i) == 0 ? 0 : at(over, i) / at(under, i)) != at(wanted, i)) return false;
  return true;
}

bool is_quotient(const WantedNumbers& wanted, const WantedNumbers& over, const WantedNumbers& under) {
  for (size_t run = 0; run < wanted.runs.size(); ++run)
    if (!is_quotient(wanted.runs[run], over.runs[run], under.runs[run])) return false;
  return true;
}

// Returns the first two columns of whole numbers whose quotient is `wanted`. It compares one of the values
// first, because there are many pairs.
std::optional<std::pair<std::string, std::string>> parts_of(const WantedNumbers& wanted,
                                                            const std::vector<WantedNumbers>& counts) {
  const auto is_some = [](double value) { return value != 0; };
  const auto run = std::find_if(wanted.runs.begin(), wanted.runs.end(), [&](const Instances& one) {
    return std::any_of(one.begin(), one.end(), is_some);
  });
  const auto sample = size_t(std::find_if(run->begin(), run->end(), is_some) - run->begin());
  const double value = (*run)[sample];
  std::vector<std::pair<const WantedNumbers*, double>> known;
  for (const WantedNumbers& one : counts) {
    const Instances& instances = one.runs[size_t(run - wanted.runs.begin())];
    if ((instances.size() == run->size() || instances.size() == 1) && at(instances, sample) != 0)
      known.emplace_back(&one, at(instances, sample));
  }
  for (const auto& [over, a] : known)
    for (const auto& [under, b] : known)
      if (a / b == value && is_quotient(wanted, *over, *under)) return std::pair{over->name, under->name};
  return std::nullopt;
}

Json quotients_of(const Columns& stats) {
  std::vector<WantedNumbers> counts, others;
  for (const std::string& name : stats.names())
    if (std::optional<WantedNumbers> numbers = numbers_of(name, stats.values(name)))
      (numbers->is_whole ? counts : others).push_back(std::move(*numbers));
  Json out = Json::object();
  for (const WantedNumbers& one : others)
    if (const auto parts = parts_of(one, counts)) out[one.name] = {parts->first, parts->second};
  return out;
}

// Moves out what a source view shows except for the counts, because it is the same for runs of the same
// programs.
void share_listing(Json& source, Json& listings) {
  Json listing = {{"files", std::move(source["files"])}, {"programs", std::move(source["programs"])}};
  source.erase("files");
  source.erase("programs");
  const auto found = std::find(listings.begin(), listings.end(), listing);
  source["listing"] = found - listings.begin();
  if (found == listings.end()) listings.push_back(std::move(listing));
}

Json without_pictures(const Json& maps) {
  Json out = maps;
  for (Json& map : out) map.erase("picture");
  return out;
}

}  // namespace

Json page_columns(const Json& data) {
  const Json& runs = data.at("runs");
  Columns stats(runs.size()), metrics(runs.size()), config(runs.size());
  const std::vector<std::pair<const char*, Columns*>> turned = {
      {"stats", &stats}, {"metrics", &metrics}, {"config", &config}};
  Json list = Json::array(), listings = Json::array();
  for (size_t i = 0; i < runs.size(); ++i) {
    for (const auto& [name, columns] : turned) columns->add(i, runs[i].value(name, Json::object()));
    Json& run = list.emplace_back(Json::object());
    for (const auto& [name, value] : runs[i].items()) {
      if (name == "timeline")
        run[name] = timeline_columns(value);
      else if (name == "heat" || name == "images")
        run[name] = without_pictures(value);
      else if (name != "stats" && name != "metrics" && name != "config" && name != "picture")
        run[name] = value;
    }
    if (!run.contains("source")) continue;
    share_listing(run["source"], listings);
    run["source"]["counts"] = count_columns(run["source"]["counts"]);
  }
  Json out = Json::object();
  for (const auto& [name, value] : data.items())
    if (name != "applications") out[name] = name == "runs" ? std::move(list) : value;
  if (stats.num_numbers() > kMaxNumbers) stats.add_up();
  const Json quotients = quotients_of(stats);
  out["stats"] = stats.json(quotients);
  out["quotients"] = quotients;
  out["metrics"] = metrics.json();
  out["config"] = config.json();
  out["listings"] = std::move(listings);
  return out;
}

}  // namespace glint::report
