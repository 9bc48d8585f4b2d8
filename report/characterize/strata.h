// Divides things into strata of like ones and draws some of each, so that the drawn ones tell the sum of all.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace glint::report {

struct DrawnRow {
  int row = 0, stratum = 0;
  double weight = 1;  // how many rows it stands for; the weights of a stratum add up to its size
};

struct Strata {
  std::vector<int> of_row;      // the stratum of each row
  int count = 0;                // of strata
  std::vector<DrawnRow> drawn;  // by row, ascending
};

// Returns how many rows have to be drawn at least: two of each kind, or one where a kind has one row.
int least_drawn(const std::vector<int>& kinds);

// Draws `count` rows, which is at least least_drawn() and at most the number of rows. Rows of different kinds
// are never in one stratum. Each column of `features` is a count: it is divided by its largest value, so that
// rows are far apart when they differ by much of the largest, which is how much a sum differs by them. There
// are as many strata, by Ward's linkage, as have room for two drawn rows each (one where a stratum has one
// row). A stratum is cut into equal parts along column 0, and one row is drawn from each part. Equal
// arguments draw equal rows.
Strata draw_rows(const Eigen::MatrixXd& features, const std::vector<int>& kinds, int count, uint64_t seed);

}  // namespace glint::report
