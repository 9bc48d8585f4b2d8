// Chooses representatives and judges them.
// SPDX-License-Identifier: Apache-2.0
#include "report/characterize/subset.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>

#include "base/diagnostics.h"
#include "report/files/csv_table.h"

namespace glint::report {
namespace {

struct Member {
  int row = 0;
  double distance = 0;
};

// Returns the rows of each cluster, nearest to its centre first.
std::vector<std::vector<Member>> members_of(const Eigen::MatrixXd& scores, const std::vector<int>& clusters) {
  std::vector<std::vector<Member>> out(size_t(std::ranges::max(clusters)) + 1);
  for (size_t row = 0; row < clusters.size(); ++row) out[size_t(clusters[row])].push_back({int(row), 0});
  for (std::vector<Member>& members : out) {
    Eigen::RowVectorXd centre = Eigen::RowVectorXd::Zero(scores.cols());
    for (const Member& member : members) centre += scores.row(member.row) / double(members.size());
    for (Member& member : members) member.distance = (scores.row(member.row) - centre).norm();
    std::ranges::stable_sort(members, {}, &Member::distance);
  }
  return out;
}

std::map<std::string, double> cycles_of(const std::string& csv, const std::string& name) {
  const CsvTable table = read_csv(csv, name);
  const auto found = std::ranges::find(table.columns, "cycles");
  if (found == table.columns.end())
    throw UserError({name, 1}, "there is no column 'cycles'", "`glint bench` writes it into metrics.csv");
  std::map<std::string, double> out;
  for (const std::vector<std::string>& row : table.rows) {
    const std::string& cell = row[size_t(found - table.columns.begin())];
    double value = 0;
    if (std::from_chars(cell.data(), cell.data() + cell.size(), value).ec == std::errc{} && value > 0)
      out[row[0]] = value;
  }
  return out;
}

SpeedUps::Range range_of(const std::map<std::string, double>& speed_ups) {
  SpeedUps::Range out;
  double sum = 0;
  for (const auto& [workload, value] : speed_ups) {
    sum += std::log(value);
    if (out.slowest.empty() || value < out.least) out.least = value, out.slowest = workload;
    if (out.fastest.empty() || value > out.most) out.most = value, out.fastest = workload;
  }
  out.mean = std::exp(sum / double(speed_ups.size()));
  return out;
}

}  // namespace

std::vector<Representative> representatives(const FeatureTable& table, const Eigen::MatrixXd& scores,
                                            const std::vector<int>& clusters) {
  const std::vector<std::vector<Member>> members = members_of(scores, clusters);
  std::vector<size_t> order(members.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](size_t cluster) { return members[cluster].size(); });
  std::vector<Representative> out(members.size());
  std::set<std::string> taken;
  for (const size_t cluster : order) {
    const auto free = std::ranges::find_if(members[cluster], [&](const Member& member) {
      return !taken.contains(table.scenes[size_t(member.row)]);
    });
    const Member& chosen = free != members[cluster].end() ? *free : members[cluster].front();
    taken.insert(table.scenes[size_t(chosen.row)]);
    out[cluster] = {.row = chosen.row, .cluster = int(cluster), .distance = chosen.distance};
  }
  return out;
}

double coverage_error(const Eigen::MatrixXd& scores, const std::vector<int>& rows) {
  double sum = 0;
  for (Eigen::Index i = 0; i < scores.rows(); ++i) {
    double nearest = INFINITY;
    for (const int row : rows) nearest = std::min(nearest, (scores.row(i) - scores.row(row)).norm());
    sum += nearest;
  }
  return sum / double(scores.rows()) / pairwise_distances(scores).mean();
}

SpeedUps speed_ups(const std::string& before, const std::string& before_name, const std::string& after,
                   const std::string& after_name, const std::vector<std::string>& names) {
  const std::map<std::string, double> was = cycles_of(before, before_name), is = cycles_of(after, after_name);
  std::map<std::string, double> all, chosen;
  for (const auto& [workload, cycles] : was)
    if (const auto found = is.find(workload); found != is.end()) all[workload] = cycles / found->second;
  for (const std::string& name : names) {
    const auto found = all.find(name);
    if (found == all.end())
      throw UserError({is.contains(name) ? before_name : after_name},
                      fmt::format("this table has no cycles of {}", name),
                      "both tables need the workloads of the subset");
    chosen[name] = found->second;
  }
  return {.all = range_of(all), .subset = range_of(chosen)};
}

}  // namespace glint::report
