// Tests that rows are divided by what they add to a sum, and that the drawn ones stand for all.
// SPDX-License-Identifier: Apache-2.0
#include "report/characterize/strata.h"

#include <algorithm>
#include <set>

#include "tests/support/catch.h"

using namespace glint::report;

namespace {

Eigen::MatrixXd column(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), Eigen::Index(values.size()));
}

}  // namespace

TEST_CASE("Every kind gives two rows, and a single row itself", "[strata]") {
  CHECK(least_drawn({0, 0, 0, 1, 2, 2}) == 5);
  const Strata strata = draw_rows(column({1, 1, 1, 1, 1, 1}), {0, 0, 0, 1, 2, 2}, 5, 1);
  CHECK(strata.count == 3);
  CHECK(strata.drawn.size() == 5);
  // Rows 3, 4 and 5 are all that their kinds have.
  std::set<int> drawn;
  for (const DrawnRow& row : strata.drawn) drawn.insert(row.row);
  CHECK((drawn.contains(3) && drawn.contains(4) && drawn.contains(5)));
}

TEST_CASE("Weights add up to the rows, and parts of a stratum have one drawn row each", "[strata]") {
  std::vector<double> sizes;
  for (int i = 0; i < 40; ++i) sizes.push_back(i < 30 ? 100 + i : 1000 + i);
  const Strata strata = draw_rows(column(sizes), std::vector<int>(40, 0), 4, 7);
  CHECK(strata.count == 2);
  CHECK(strata.of_row[0] == strata.of_row[29]);
  CHECK(strata.of_row[0] != strata.of_row[30]);
  double weights = 0;
  for (const DrawnRow& row : strata.drawn) {
    weights += row.weight;
    CHECK(row.stratum == strata.of_row[size_t(row.row)]);
  }
  CHECK(weights == 40);
  REQUIRE(strata.drawn.size() == 4);
  CHECK(strata.drawn[0].row < 15);
  CHECK(strata.drawn[1].row >= 15);
  CHECK(strata.drawn[1].row < 30);
  CHECK(strata.drawn[2].row < 35);
  CHECK(strata.drawn[3].row >= 35);
}

TEST_CASE("Kinds are apart even when all counts are equal", "[strata]") {
  const std::vector<int> kinds = {0, 1, 0, 1, 0, 1, 0, 1};
  const Strata strata = draw_rows(column(std::vector<double>(8, 5.0)), kinds, 4, 1);
  for (size_t i = 0; i < kinds.size(); ++i)
    for (size_t j = 0; j < kinds.size(); ++j)
      if (kinds[i] != kinds[j]) CHECK(strata.of_row[i] != strata.of_row[j]);
}

TEST_CASE("Equal seeds draw equal rows, and other seeds draw others", "[strata]") {
  std::vector<double> sizes;
  for (int i = 0; i < 100; ++i) sizes.push_back(i);
  const auto drawn = [&](uint64_t seed) {
    std::vector<int> rows;
    for (const DrawnRow& row : draw_rows(column(sizes), std::vector<int>(100, 0), 10, seed).drawn)
      rows.push_back(row.row);
    return rows;
  };
  CHECK(drawn(1) == drawn(1));
  CHECK(drawn(1) != drawn(2));
  CHECK(std::ranges::is_sorted(drawn(1)));
}

TEST_CASE("Thousands of rows are divided, too", "[strata]") {
  std::vector<double> sizes;
  for (int i = 0; i < 5000; ++i) sizes.push_back(1 + i % 50 + 1e-4 * i);
  const Strata strata = draw_rows(column(sizes), std::vector<int>(5000, 0), 100, 1);
  CHECK(strata.drawn.size() == 100);
  CHECK(strata.count <= 50);
  CHECK(strata.count >= 40);
}
