// Tests the characterisation against values of numpy, SciPy and scikit-learn (reference.py), and on odd
// tables.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/diagnostics.h"
#include "report/characterize/characterization.h"
#include "report/characterize/characterization_files.h"
#include "tests/support/catch.h"

using namespace glint;
using namespace glint::report;

namespace {

const std::string kData = std::string(GLINT_SOURCE_DIR) + "/tests/unit/characterize/data/";

std::string text_of(const std::string& name) {
  std::ifstream in(kData + name, std::ios::binary);
  REQUIRE(in);
  return {std::istreambuf_iterator<char>(in), {}};
}

const FeatureTable& suite() {
  static const FeatureTable table = feature_table(text_of("metrics.csv"), "metrics.csv");
  return table;
}
const nlohmann::json& expected() {
  static const nlohmann::json json = nlohmann::json::parse(text_of("expected.json"));
  return json;
}

// Returns the largest difference of two matrices, of which the second is given as rows of rows.
double difference(const Eigen::MatrixXd& values, const nlohmann::json& rows) {
  REQUIRE(size_t(values.rows()) == rows.size());
  REQUIRE(size_t(values.cols()) == rows[0].size());
  double most = 0;
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    for (Eigen::Index j = 0; j < values.cols(); ++j)
      most = std::max(most, std::abs(values(i, j) - rows[size_t(i)][size_t(j)].get<double>()));
  return most;
}

// Returns whether the groups are the same, whatever their numbers are.
bool same_groups(const std::vector<int>& a, const std::vector<int>& b) {
  for (size_t i = 0; i < a.size(); ++i)
    for (size_t j = 0; j < i; ++j)
      if ((a[i] == a[j]) != (b[i] == b[j])) return false;
  return a.size() == b.size();
}

std::string message_of(const std::string& csv) {
  try {
    feature_table(csv, "table.csv");
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("The columns that take part are those that vary, have every number and say something new",
          "[characterize]") {
  CHECK(suite().metrics == expected()["metrics"].get<std::vector<std::string>>());
  CHECK(suite().rows() == 46);
  const auto why = [](const std::string& name) {
    for (const FeatureTable::Dropped& one : suite().dropped)
      if (one.column == name) return one.why;
    return std::string();
  };
  CHECK(why("thrd_icount") == "equal to insn");
  CHECK(why("n_raygen") == "constant: 16384");
  CHECK(why("rt_store_q_max") == "empty");
  CHECK(why("sim_rate") == "the host's speed, not the workload's");
  CHECK(why("cycles").empty());
}

TEST_CASE("Eigenvalues, loadings and scores are scikit-learn's", "[characterize]") {
  const PrincipalComponents pca = principal_components(suite().standardised);
  const auto eigenvalues = expected()["eigenvalues"].get<std::vector<double>>();
  REQUIRE(pca.kept == expected()["kept"].get<int>());
  for (size_t i = 0; i < eigenvalues.size() && i < size_t(pca.eigenvalues.size()); ++i)
    CHECK(std::abs(pca.eigenvalues[Eigen::Index(i)] - eigenvalues[i]) < 1e-10 * eigenvalues[0]);
  CHECK(std::abs(pca.eigenvalues.sum() - double(suite().columns())) < 1e-9);
  CHECK(difference(pca.loadings, expected()["loadings"]) < 1e-9);
  CHECK(difference(pca.scores, expected()["scores"]) < 1e-8);
}

TEST_CASE("Columns of the largest and the smallest doubles are standardised as others", "[characterize]") {
  Eigen::MatrixXd values(4, 2);
  values << 1, 8, 2, 6, 3, 7, 5, 1;
  const Eigen::MatrixXd plain = standardised(values);
  CHECK(plain == standardised(values * 0x1p1020));
  CHECK(plain == standardised(values * 0x1p-1060));
  CHECK(plain.colwise().squaredNorm().isApproxToConstant(4));
}

TEST_CASE("Trees, their leaves and their cuts are SciPy's with every linkage", "[characterize]") {
  const PrincipalComponents pca = principal_components(suite().standardised);
  for (const Linkage linkage : {Linkage::Single, Linkage::Complete, Linkage::Average, Linkage::Ward}) {
    const std::string name(name_of(linkage));
    INFO(name);
    CHECK(linkage_of(name) == linkage);
    const nlohmann::json& tree = expected()["trees"][name];
    const std::vector<Join> joins = hierarchy(pca.scores, linkage);
    REQUIRE(joins.size() == tree["linkage"].size());
    for (size_t i = 0; i < joins.size(); ++i) {
      const nlohmann::json& row = tree["linkage"][i];
      CHECK(joins[i].first == row[0].get<int>());
      CHECK(joins[i].second == row[1].get<int>());
      CHECK(std::abs(joins[i].distance - row[2].get<double>()) < 1e-8);
      CHECK(joins[i].size == row[3].get<int>());
    }
    CHECK(leaf_order(joins) == tree["leaves"].get<std::vector<int>>());
    CHECK(same_groups(clusters(joins, 8), tree["clusters"].get<std::vector<int>>()));
    CHECK(std::abs(cophenetic_correlation(joins, pca.scores) - tree["cophenetic"].get<double>()) < 1e-10);
  }
}

TEST_CASE("A set of metrics is worth the correlation that numpy gives it", "[characterize]") {
  const DistanceFitness fitness(suite().standardised);
  CHECK(std::abs(fitness({0, 1, 2, 3, 4, 5, 6, 7}) - expected()["fitness_of_first_eight"].get<double>()) <
        1e-10);
  std::vector<int> all;
  for (int i = 0; i < int(fitness.metrics()); ++i) all.push_back(i);
  CHECK(std::abs(fitness(all) - 1) < 1e-12);
}

TEST_CASE("The genetic algorithm finds the best three of ten metrics, with every seed", "[characterize]") {
  const nlohmann::json& small = expected()["small"];
  const DistanceFitness fitness(suite().standardised.leftCols(small["columns"].get<int>()));
  for (uint64_t seed = 1; seed <= 5; ++seed) {
    const ChosenMetrics found =
        choose_metrics(fitness, {.count = 3, .seed = seed, .islands = 2, .population = 20, .patience = 30});
    std::vector<int> columns;
    for (const ChosenMetrics::Metric& metric : found.metrics) columns.push_back(metric.column);
    std::ranges::sort(columns);
    CHECK(columns == small["best"].get<std::vector<int>>());
    CHECK(std::abs(found.fitness - small["fitness"].get<double>()) < 1e-10);
    CHECK(found.fitness > small["second"].get<double>());
  }
}

TEST_CASE("The genetic algorithm finds the best four of twenty metrics without trying all",
          "[characterize]") {
  constexpr int kColumns = 20;
  const DistanceFitness fitness(suite().standardised.leftCols(kColumns));
  double best = -1;
  int sets = 0;
  for (int a = 0; a < kColumns; ++a)
    for (int b = a + 1; b < kColumns; ++b)
      for (int c = b + 1; c < kColumns; ++c)
        for (int d = c + 1; d < kColumns; ++d, ++sets) best = std::max(best, fitness({a, b, c, d}));
  const ChosenMetrics found =
      choose_metrics(fitness, {.count = 4, .islands = 2, .population = 24, .patience = 30});
  CHECK(std::abs(found.fitness - best) < 1e-12);
  CHECK(found.evaluations < sets);
}

TEST_CASE("The same seed gives the same eight metrics, and no exchange of one makes them better",
          "[characterize]") {
  const DistanceFitness fitness(suite().standardised);
  const ChosenMetrics first = choose_metrics(fitness, {}), second = choose_metrics(fitness, {});
  std::vector<int> columns;
  for (size_t i = 0; i < first.metrics.size(); ++i) {
    columns.push_back(first.metrics[i].column);
    CHECK(first.metrics[i].column == second.metrics[i].column);
    CHECK(first.metrics[i].fitness_without < first.fitness);
  }
  REQUIRE(columns.size() == 8);
  CHECK(first.fitness == second.fitness);
  for (size_t at = 0; at < columns.size(); ++at)
    for (int other = 0; other < int(fitness.metrics()); ++other) {
      std::vector<int> changed = columns;
      changed[at] = other;
      if (std::ranges::count(columns, other) == 0) CHECK(fitness(changed) <= first.fitness + 1e-12);
    }
}

TEST_CASE("A subset has one workload of each cluster and no scene twice where others are left",
          "[characterize]") {
  const Characterization result = characterize(suite(), {.search = {.generations = 1},
                                                         .reference = {"SHIP_SH", "CHSNT_PT", "NOT_THERE"},
                                                         .reference_name = "two"});
  REQUIRE(result.chosen.size() == 8);
  std::vector<std::string> scenes;
  for (size_t i = 0; i < result.chosen.size(); ++i) {
    CHECK(result.cluster_of[size_t(result.chosen[i].row)] == int(i));
    scenes.push_back(suite().scenes[size_t(result.chosen[i].row)]);
  }
  std::ranges::sort(scenes);
  CHECK(std::ranges::adjacent_find(scenes) == scenes.end());
  CHECK(result.reference.rows.size() == 2);
  CHECK(result.subset.coverage_error < result.reference.coverage_error);
  std::vector<int> everyone(size_t(suite().rows()));
  for (size_t i = 0; i < everyone.size(); ++i) everyone[i] = int(i);
  CHECK(coverage_error(result.components.scores, everyone) == 0);
}

TEST_CASE("Speed-ups of a subset are those of its own workloads", "[characterize]") {
  const std::string before = "workload,cycles\nA,100\nB,200\nC,400\nD,5\n",
                    after = "workload,cycles\nA,50\nB,200\nC,100\n";
  const SpeedUps found = speed_ups(before, "before", after, "after", {"A", "B"});
  CHECK(std::abs(found.all.mean - 2) < 1e-12);  // the mean of 2, 1 and 4
  CHECK(found.all.fastest == "C");
  CHECK(std::abs(found.subset.mean - std::sqrt(2.0)) < 1e-12);
  CHECK(found.subset.slowest == "B");
  CHECK_THROWS_WITH(speed_ups(before, "before", after, "after", {"D"}),
                    Catch::Contains("after: error: this table has no cycles of D"));
}

TEST_CASE("Tables that cannot be compared are refused with the reason", "[characterize]") {
  CHECK(message_of("").find("no header") != std::string::npos);
  CHECK(message_of("workload,a,b\nX,1,2\nY,2,1\n").find("2 workloads, expected at least 3") !=
        std::string::npos);
  CHECK(message_of("workload,a,b\nX,1,2\nY,2,1\nX,3,1\n").find("'X' is in the table twice") !=
        std::string::npos);
  CHECK(message_of("workload,a,b\nX,1,2\nY,2\nZ,3,1\n").find("table.csv:3") != std::string::npos);
  CHECK(message_of("workload,a,b\nX,1,7\nY,2,7\nZ,3,7\n").find("1 columns of numbers that vary") !=
        std::string::npos);
  CHECK(message_of("workload,a,b\n\"X,1,2\nY,2,1\n").find("a quote is not closed") != std::string::npos);
}

TEST_CASE("Files hold what was computed, to the last bit", "[characterize]") {
  const FeatureTable table =
      feature_table("name,a,b,c\nX_PT,1,2,0.1\nY_SH,2,1,0.7\n\"Z,AO\",3,1,0.2\nW_PT,9,1,0.3\n", "t");
  const Characterization result =
      characterize(table, {.clusters = 2, .search = {.count = 2}, .reference = {}, .reference_name = {}});
  for (const auto& [name, content] : characterization_files(result)) {
    if (name == "scores.csv") CHECK(content.find("\"Z,AO\",") != std::string::npos);
    if (name == "linkage.csv") CHECK(std::ranges::count(content, '\n') == 4);
    if (name == "eigenvalues.csv") {
      const size_t at = content.find("PC1,") + 4;
      CHECK(std::stod(content.substr(at)) == result.components.eigenvalues[0]);
    }
  }
}
