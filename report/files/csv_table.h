// Reads a table of comma-separated values: a header and rows of text.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

namespace glint::report {

struct CsvTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  // each row is as long as `columns`
};

// Reads RFC 4180, with lines that end in LF or CRLF. Throws UserError that names file and line when a row has
// another number of cells than the header, a quote is not closed, or there is no header. `name` is used in
// messages.
CsvTable read_csv(const std::string& text, const std::string& name);

}  // namespace glint::report
