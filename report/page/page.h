// The HTML report: one page that holds its data, its script and tables that read without it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace glint::report {

// The page's parts that do not depend on the runs: web/ in the source tree.
struct PageParts {
  std::string frame;  // HTML with the places <!--style-->, <!--title-->, <!--noscript-->, <!--sections-->,
                      // <!--data--> and <!--script-->
  std::string style, script;
  std::string unpack;  // a script that unpacks the other and runs it
};

// `data` is page_data(), which may have "characterizations" and "models" (page_suite.h) added; the page holds
// it as page_columns() has it. UserError when the frame lacks a place.
std::string page(const nlohmann::ordered_json& data, const PageParts& parts);

}  // namespace glint::report
