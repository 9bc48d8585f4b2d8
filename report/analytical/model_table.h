// Predicted beside simulated cycles of several workloads, and how good each model is.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

namespace glint::report {

struct ModelRow {
  std::string workload;
  double cycles = 0;                                   // simulated
  std::vector<double> predicted;                       // by model
  std::vector<std::pair<std::string, double>> inputs;  // and intermediate values, the same names in every row
};

struct ModelScore {
  double r2 = 0;  // of the linear regression of simulated on predicted cycles, as LumiBench gives it: blind
                  // to a constant factor
  double mean_error = 0;  // mean of |predicted / simulated - 1|
  double worst_error = 0;
  std::string worst;  // workload
  double ratio = 0;   // geometric mean of predicted / simulated: the bias
};

struct ModelTable {
  std::vector<std::string> models;  // names
  std::vector<ModelRow> rows;

  // R2 of a single workload is 0.
  ModelScore score(size_t model) const;
};

std::string model_text(const ModelTable& table);  // for a terminal
std::string model_csv(const ModelTable& table);   // workload, cycles, a column a model and input
// Reads model_csv() back. UserError where the text is none.
ModelTable parse_models(const std::string& csv, const std::string& name);
nlohmann::ordered_json models_json(
    const ModelTable& table);  // {"models": [{name, r2, mape, ratio, worst, worst_error}], "workloads":
                               // [{name, cycles, predicted}]}

}  // namespace glint::report
