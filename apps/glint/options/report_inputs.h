// What the arguments of `glint report` name: runs, and what other commands have computed of whole suites.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace glint::app {

// A characterisation or a table of models.
struct SuiteInput {
  std::string folder;               // whose runs it is about; "" where nothing says so
  nlohmann::ordered_json document;  // an element of report::suite_sections()'s lists
};

struct ReportInputs {
  std::vector<std::string> runs;  // directories, those of a bench in order of their names
  std::vector<SuiteInput> characterizations, models;
};

// Named may be: directories of runs, folders of `glint bench` (with the models.csv and the folder
// `characterization` that are in them), folders of `glint characterize`, tables of `glint model`, folders
// with such a table. UserError where a table or document cannot be read; directories that are of none of
// these count as runs, for report::page_data() to refuse.
ReportInputs report_inputs(const std::vector<std::string>& named);

// Puts into the page's document what is said of suites. Whether the numbers are those of the runs beside them
// is told by cycles.
void add_suites(const ReportInputs& inputs, nlohmann::ordered_json& data);

}  // namespace glint::app
