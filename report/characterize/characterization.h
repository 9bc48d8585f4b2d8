// Does the diversity analysis of LumiBench (its section 3.4) over a table of metrics: all steps in order.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "report/characterize/clustering.h"
#include "report/characterize/feature_table.h"
#include "report/characterize/metric_search.h"
#include "report/characterize/principal_components.h"
#include "report/characterize/subset.h"

namespace glint::report {

struct CharacterizationOptions {
  Linkage linkage = Linkage::Average;
  int clusters = 8;  // number of clusters, and of workloads in the subset; at most the number of workloads
  SearchSettings search;  // settings of the search for representative metrics
  // These are the names of a published subset to compare with. Those that the table lacks are left out.
  std::vector<std::string> reference;
  std::string reference_name;  // for example "the paper's subset"
};

// Holds a set of workloads that stands for all.
struct Subset {
  std::vector<int> rows;
  double coverage_error = 0;  // what coverage_error() returned
  int clusters_met = 0;       // number of clusters with one of the rows
};

struct Characterization {
  CharacterizationOptions options;
  FeatureTable table;
  PrincipalComponents components;
  std::vector<Join> joins;
  std::vector<int> leaves;      // rows, from left to right of the dendrogram
  std::vector<int> cluster_of;  // cluster of each row
  // A line between these two distances crosses as many branches as there are clusters.
  double cut_low = 0, cut_high = 0;
  double cophenetic = 0;
  std::vector<Representative> chosen;  // ordered by cluster
  Subset subset, reference;            // `reference` is empty without options.reference
  ChosenMetrics metrics;
  Eigen::MatrixXd kiviat;  // workloads x chosen metrics; 0 is the least of all workloads, and 1 is the most
};

// Does the analysis. Throws as feature_table() does. The same table and options give the same result on every
// machine, up to rounding.
Characterization characterize(FeatureTable table, const CharacterizationOptions& options);

// Returns the text for a terminal: what was dropped, components, clusters with their representatives,
// metrics.
std::string characterization_text(const Characterization& result);

}  // namespace glint::report
