// Clusters agglomeratively by the Lance-Williams recurrence.
// SPDX-License-Identifier: Apache-2.0
#include "report/characterize/clustering.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/diagnostics.h"
#include "report/characterize/correlation.h"
#include "report/characterize/feature_table.h"

namespace glint::report {
namespace {

constexpr std::pair<std::string_view, Linkage> kNames[] = {{"single", Linkage::Single},
                                                           {"complete", Linkage::Complete},
                                                           {"average", Linkage::Average},
                                                           {"ward", Linkage::Ward}};

struct Group {
  int number = 0, size = 1;
};

// Returns the distance of group k to the union of i and j (Lance and Williams 1967), from the distances
// before. Ward's linkage takes distances, not their squares.
double distance_to_union(Linkage linkage, double ik, double jk, double ij, double i, double j, double k) {
  switch (linkage) {
    case Linkage::Single:
      return std::min(ik, jk);
    case Linkage::Complete:
      return std::max(ik, jk);
    case Linkage::Average:
      return (i * ik + j * jk) / (i + j);
    case Linkage::Ward:
      return std::sqrt(((i + k) * ik * ik + (j + k) * jk * jk - k * ij * ij) / (i + j + k));
  }
  return 0;
}

std::pair<size_t, size_t> nearest_pair(const Eigen::MatrixXd& distance, const std::vector<Group>& groups) {
  std::pair<size_t, size_t> best{0, 1};
  for (size_t i = 0; i < groups.size(); ++i)
    for (size_t j = i + 1; j < groups.size(); ++j)
      if (distance(Eigen::Index(i), Eigen::Index(j)) <
          distance(Eigen::Index(best.first), Eigen::Index(best.second)))
        best = {i, j};
  return best;
}

void drop_row(Eigen::MatrixXd& distance, Eigen::Index row) {
  const Eigen::Index rest = distance.rows() - row - 1;
  distance.middleRows(row, rest) = distance.bottomRows(rest).eval();
  distance.middleCols(row, rest) = distance.rightCols(rest).eval();
  distance.conservativeResize(distance.rows() - 1, distance.cols() - 1);
}

// Collects the leaves below a node, from left to right.
void collect(const std::vector<Join>& joins, int node, std::vector<int>& leaves) {
  const int n = int(joins.size()) + 1;
  if (node < n) {
    leaves.push_back(node);
    return;
  }
  collect(joins, joins[size_t(node - n)].first, leaves);
  collect(joins, joins[size_t(node - n)].second, leaves);
}

}  // namespace

Linkage linkage_of(const std::string& name) {
  for (const auto& [text, linkage] : kNames)
    if (name == text) return linkage;
  throw UserError({}, "there is no linkage '" + name + "'",
                  "the linkages are single, complete, average and ward");
}

std::string_view name_of(Linkage linkage) {
  for (const auto& [text, value] : kNames)
    if (value == linkage) return text;
  return "";
}

std::vector<Join> hierarchy(const Eigen::MatrixXd& scores, Linkage linkage) {
  const int n = int(scores.rows());
  std::vector<Group> groups(static_cast<size_t>(n));
  for (int i = 0; i < n; ++i) groups[size_t(i)].number = i;
  Eigen::MatrixXd distance(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) distance(i, j) = (scores.row(i) - scores.row(j)).norm();
  std::vector<Join> joins;
  while (groups.size() > 1) {
    const auto [i, j] = nearest_pair(distance, groups);
    const Group a = groups[i], b = groups[j];
    const auto row = Eigen::Index(i), other = Eigen::Index(j);
    const double ij = distance(row, other);
    joins.push_back({.first = std::min(a.number, b.number),
                     .second = std::max(a.number, b.number),
                     .distance = ij,
                     .size = a.size + b.size});
    for (size_t k = 0; k < groups.size(); ++k) {
      if (k == i || k == j) continue;
      const auto at = Eigen::Index(k);
      distance(row, at) = distance(at, row) = distance_to_union(
          linkage, distance(row, at), distance(other, at), ij, a.size, b.size, groups[k].size);
    }
    groups[i] = {.number = n + int(joins.size()) - 1, .size = a.size + b.size};
    groups.erase(groups.begin() + std::ptrdiff_t(j));
    drop_row(distance, other);
  }
  return joins;
}

std::vector<int> leaf_order(const std::vector<Join>& joins) {
  std::vector<int> leaves;
  collect(joins, 2 * int(joins.size()), leaves);
  return leaves;
}

std::vector<int> clusters(const std::vector<Join>& joins, int count) {
  const int n = int(joins.size()) + 1, kept = n - count;  // `kept` joins stay.
  std::vector<int> parent(size_t(2 * n - 1), -1);
  for (int i = 0; i < kept; ++i)
    parent[size_t(joins[size_t(i)].first)] = parent[size_t(joins[size_t(i)].second)] = n + i;
  std::vector<int> out(size_t(n), -1), roots;
  for (const int leaf : leaf_order(joins)) {
    int root = leaf;
    while (parent[size_t(root)] >= 0) root = parent[size_t(root)];
    if (roots.empty() || roots.back() != root)
      roots.push_back(root);  // The leaves of a group are neighbours in this order.
    out[size_t(leaf)] = int(roots.size()) - 1;
  }
  return out;
}

double cophenetic_correlation(const std::vector<Join>& joins, const Eigen::MatrixXd& scores) {
  const int n = int(joins.size()) + 1;
  Eigen::MatrixXd joined = Eigen::MatrixXd::Zero(n, n);
  for (const Join& join : joins) {
    std::vector<int> left, right;
    collect(joins, join.first, left);
    collect(joins, join.second, right);
    for (const int a : left)
      for (const int b : right) joined(a, b) = joined(b, a) = join.distance;
  }
  Eigen::VectorXd flat(n * (n - 1) / 2);
  for (int i = 0, at = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j) flat[at++] = joined(i, j);
  return correlation(flat, pairwise_distances(scores));
}

}  // namespace glint::report
