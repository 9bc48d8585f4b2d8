// Tabulates predicted beside simulated cycles of several workloads, with scores of each model.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

namespace glint::report {

struct ModelRow {
  std::string workload;
  double cycles = 0;              // simulated cycles
  std::vector<double> predicted;  // cycles that each model predicts
  // These are inputs and intermediate values. Every row has the same names.
  std::vector<std::pair<std::string, double>> inputs;
};

struct ModelScore {
  // This is R2 of the linear regression of simulated on predicted cycles, as LumiBench gives it. It is blind
  // to a constant factor.
  double r2 = 0;
  double mean_error = 0;  // mean of |predicted / simulated - 1|
  double worst_error = 0;
  std::string worst;  // the workload of the worst error
  double ratio = 0;   // geometric mean of predicted / simulated, which is the bias
};

struct ModelTable {
  std::vector<std::string> models;  // names of the models
  std::vector<ModelRow> rows;

  // Returns the scores of a model. R2 of a single workload is 0.
  ModelScore score(size_t model) const;
};

// Returns a text for a terminal.
std::string model_text(const ModelTable& table);
// Returns the columns: workload, cycles, then one for each model and input.
std::string model_csv(const ModelTable& table);
// Reads model_csv() back. Throws UserError when the text is not such a table.
ModelTable parse_models(const std::string& csv, const std::string& name);
// Returns {"models": [{name, r2, mape, ratio, worst, worst_error}], "workloads": [{name, cycles,
// predicted}]}.
nlohmann::ordered_json models_json(const ModelTable& table);

}  // namespace glint::report
