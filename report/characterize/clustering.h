// Clusters hierarchically: finds which workloads are alike, and at which distance groups of them join.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace glint::report {

// Names how the distance between two groups is measured: by the nearest pair, the farthest pair, the mean of
// all pairs, or by how much joining them raises the sum of squares within groups (Ward).
enum class Linkage { Single, Complete, Average, Ward };
// Returns the linkage "single", "complete", "average" or "ward". Throws UserError for any other name.
Linkage linkage_of(const std::string& name);
std::string_view name_of(Linkage linkage);

// Holds two groups that join. A leaf's number is its row; the group of join i has number n + i, as in SciPy.
struct Join {
  int first = 0, second = 0;  // first < second
  double distance = 0;        // distance in the units of the scores
  int size = 0;               // leaves of both groups
};

// Returns n - 1 joins, nearest first. `scores` has a row for each workload, and at least two rows. Of equally
// near pairs, the one with the lowest rows joins first.
std::vector<Join> hierarchy(const Eigen::MatrixXd& scores, Linkage linkage);

// Returns the leaves from left to right, so that no lines of a dendrogram cross.
std::vector<int> leaf_order(const std::vector<Join>& joins);

// Returns the group of each leaf when the last `count` - 1 joins are undone (1 <= count <= leaves). Groups
// are numbered from 0 in leaf_order().
std::vector<int> clusters(const std::vector<Join>& joins, int count);

// Returns the correlation of the distances with the distances at which leaves join (the cophenetic
// correlation), from -1 to 1. It tells how well the tree shows the distances.
double cophenetic_correlation(const std::vector<Join>& joins, const Eigen::MatrixXd& scores);

}  // namespace glint::report
