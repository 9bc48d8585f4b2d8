// A table of comma-separated values read whole: a header and rows of text.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace glint::report {

struct CsvTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  // each as long as `columns`
};

// RFC 4180, lines ended by LF or CRLF. UserError naming file and line where a row has another number of cells
// than the header, a quote is not closed, or there is no header. `name` stands in messages.
CsvTable read_csv(const std::string& text, const std::string& name);

}  // namespace glint::report
