// Writes the HTML report: one page that holds its data, its script, and tables for readers without script.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace glint::report {

// Holds the page's parts that do not depend on the runs. They are in web/ of the source tree.
struct PageParts {
  // This is HTML with the places <!--style-->, <!--title-->, <!--noscript-->, <!--sections-->, <!--data-->
  // and <!--script-->.
  std::string frame;
  std::string style, script;
  std::string unpack;  // a script that unpacks the other one and runs it
};

// Returns the page. `data` is page_data(), to which "characterizations" and "models" (suite.h), "collections"
// (collection.h) and "applications" (application.h) may be added; the page holds it as page_columns() returns
// it. Throws UserError when the frame lacks a place.
std::string page(const nlohmann::ordered_json& data, const PageParts& parts);

}  // namespace glint::report
