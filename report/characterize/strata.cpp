// Cuts a tree of joins into strata and draws rows from them.
// SPDX-License-Identifier: Apache-2.0
#include "report/characterize/strata.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <tuple>

#include "base/split_mix.h"
#include "report/characterize/clustering.h"

namespace glint::report {
namespace {

// Choice: a tree of so many rows takes a second. Of more rows, near ones join before the tree is made.
constexpr size_t kMostLeaves = 1000;

int least_of(int size) {
  return std::min(2, size);
}

Eigen::MatrixXd scaled(const Eigen::MatrixXd& features) {
  Eigen::MatrixXd out = features;
  for (Eigen::Index column = 0; column < out.cols(); ++column)
    if (const double most = out.col(column).cwiseAbs().maxCoeff(); most > 0) out.col(column) /= most;
  return out;
}

// Returns rows that are alike, each list with the lowest row first. Rows of a list differ from its first one
// by at most `distance`.
std::vector<std::vector<int>> near_rows(const Eigen::MatrixXd& features, const std::vector<int>& kinds,
                                        double distance) {
  std::vector<std::vector<int>> out;
  for (int row = 0; row < int(features.rows()); ++row) {
    const auto is_near = [&](const std::vector<int>& list) {
      return kinds[size_t(list[0])] == kinds[size_t(row)] &&
             (features.row(list[0]) - features.row(row)).norm() <= distance;
    };
    const auto found = std::ranges::find_if(out, is_near);
    if (found != out.end())
      found->push_back(row);
    else
      out.push_back({row});
    if (out.size() > kMostLeaves) break;
  }
  return out;
}

// Returns the joins of lists of rows. Kinds join last, because nothing else is as far apart.
std::vector<Join> joins_of(const Eigen::MatrixXd& features, const std::vector<int>& kinds,
                           const std::vector<std::vector<int>>& lists) {
  constexpr double kFar = 1e6;
  const int num_kinds = *std::ranges::max_element(kinds) + 1;
  Eigen::MatrixXd leaves = Eigen::MatrixXd::Zero(Eigen::Index(lists.size()), features.cols() + num_kinds);
  for (size_t i = 0; i < lists.size(); ++i) {
    leaves.row(Eigen::Index(i)).head(features.cols()) = features.row(lists[i][0]);
    leaves(Eigen::Index(i), features.cols() + kinds[size_t(lists[i][0])]) = kFar;
  }
  return lists.size() > 1 ? hierarchy(leaves, Linkage::Ward) : std::vector<Join>{};
}

using Rows = std::vector<int>;

// Returns the strata when the tree is cut into `count`.
std::vector<Rows> cut(const std::vector<Join>& joins, const std::vector<Rows>& lists, int count) {
  std::vector<Rows> out(static_cast<size_t>(count));
  const std::vector<int> of_list = clusters(joins, count);
  for (size_t i = 0; i < lists.size(); ++i) {
    Rows& stratum = out[size_t(of_list[i])];
    stratum.insert(stratum.end(), lists[i].begin(), lists[i].end());
  }
  return out;
}

int least_of(const std::vector<Rows>& strata) {
  int sum = 0;
  for (const Rows& stratum : strata) sum += least_of(int(stratum.size()));
  return sum;
}

// Returns how many rows each stratum gives: two, and more where most rows stand for one drawn.
std::vector<int> shares(const std::vector<Rows>& strata, int count) {
  std::vector<int> out;
  for (const Rows& stratum : strata) out.push_back(least_of(int(stratum.size())));
  const auto stands_for = [&](size_t i) {
    return size_t(out[i]) < strata[i].size() ? double(strata[i].size()) / out[i] : 0;
  };
  for (int left = count - least_of(strata); left > 0; --left) {
    size_t most = 0;
    for (size_t i = 1; i < strata.size(); ++i)
      if (stands_for(i) > stands_for(most)) most = i;
    if (stands_for(most) == 0) break;
    ++out[most];
  }
  return out;
}

}  // namespace

int least_drawn(const std::vector<int>& kinds) {
  std::map<int, int> sizes;
  for (const int kind : kinds) ++sizes[kind];
  int sum = 0;
  for (const auto& [kind, size] : sizes) sum += least_of(size);
  return sum;
}

Strata draw_rows(const Eigen::MatrixXd& features, const std::vector<int>& kinds, int count, uint64_t seed) {
  const Eigen::MatrixXd rows = scaled(features);
  double distance = 0;
  std::vector<Rows> lists = near_rows(rows, kinds, distance);
  for (; lists.size() > kMostLeaves; lists = near_rows(rows, kinds, distance))
    distance = std::max(1e-3, 2 * distance);
  const std::vector<Join> joins = joins_of(rows, kinds, lists);
  int num_strata = *std::ranges::max_element(kinds) + 1;
  while (num_strata < int(lists.size()) && least_of(cut(joins, lists, num_strata + 1)) <= count) ++num_strata;
  std::vector<Rows> strata = cut(joins, lists, num_strata);
  const std::vector<int> share = shares(strata, count);
  Strata out{std::vector<int>(size_t(rows.rows())), num_strata, {}};
  SplitMix numbers(seed);
  for (size_t s = 0; s < strata.size(); ++s) {
    Rows& stratum = strata[s];
    std::ranges::sort(stratum, {}, [&](int row) { return std::tuple(rows(row, 0), row); });
    for (const int row : stratum) out.of_row[size_t(row)] = int(s);
    for (int part = 0; part < share[s]; ++part) {
      const int begin = int(stratum.size()) * part / share[s],
                end = int(stratum.size()) * (part + 1) / share[s];
      out.drawn.push_back(
          {stratum[size_t(begin) + numbers.below(uint32_t(end - begin))], int(s), double(end - begin)});
    }
  }
  std::ranges::sort(out.drawn, {}, &DrawnRow::row);
  return out;
}

}  // namespace glint::report
