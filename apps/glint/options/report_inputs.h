// Finds what the arguments of `glint report` name: runs, and what other commands computed of whole suites.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace glint::app {

// Holds a characterisation or a table of models.
struct SuiteInput {
  std::string folder;               // the folder of its runs; "" when nothing names it
  nlohmann::ordered_json document;  // an element of report::suite_sections()'s lists
};

struct ReportInputs {
  std::vector<std::string> runs;  // directories; those of a bench are ordered by name
  std::vector<SuiteInput> characterizations, models;
  std::vector<nlohmann::ordered_json> labs;  // as `glint lab` leaves them in lab.json
  // These are elements of "collections" (report/page/collection.h), whose points have no "link" yet.
  std::vector<nlohmann::ordered_json> collections;
  // These are elements of "applications" (report/page/application.h), which have no "links" yet.
  std::vector<nlohmann::ordered_json> applications;
};

// Finds the inputs that `named` means: directories of runs, folders of `glint bench` (with the models.csv and
// the folder `characterization` in them), folders of sweeps (with a sweep.json), folders of `glint lab` (with
// a lab.json), folders of applications of the Vulkan driver (with an index.json), folders of `glint
// characterize`, tables of `glint model`, and folders with such a table. Throws UserError when a table or
// document cannot be read. Directories that are none of these count as runs, and report::page_data() refuses
// them.
ReportInputs report_inputs(const std::vector<std::string>& named);

// Puts what is said of suites into the page's document. Cycles tell whether the numbers are those of the runs
// beside them.
void add_suites(const ReportInputs& inputs, nlohmann::ordered_json& data);

}  // namespace glint::app
