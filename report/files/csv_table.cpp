// Splits comma-separated values.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/csv_table.h"

#include <fmt/format.h>
#include <utility>

#include "base/diagnostics.h"

namespace glint::report {
namespace {

// Reads one record, which may span lines within quotes, and advances `at` and `line` behind it.
std::vector<std::string> record(const std::string& text, size_t& at, int& line, const std::string& name) {
  std::vector<std::string> cells(1);
  bool in_quotes = false;
  const int first = line;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '\n') ++line;
    if (in_quotes) {
      if (c != '"')
        cells.back() += c;
      else if (at + 1 < text.size() && text[at + 1] == '"')
        cells.back() += text[++at];
      else
        in_quotes = false;
    } else if (c == '"' && cells.back().empty()) {
      in_quotes = true;
    } else if (c == ',') {
      cells.emplace_back();
    } else if (c == '\n') {
      ++at;
      break;
    } else if (c != '\r') {
      cells.back() += c;
    }
  }
  if (in_quotes) throw UserError({name, first}, "a quote is not closed");
  return cells;
}

}  // namespace

CsvTable read_csv(const std::string& text, const std::string& name) {
  CsvTable table;
  size_t at = 0;
  int line = 1;
  table.columns = record(text, at, line, name);
  if (table.columns.size() == 1 && table.columns[0].empty())
    throw UserError({name, 1}, "there is no header", "expected a table of comma-separated values");
  while (at < text.size()) {
    const int first = line;
    std::vector<std::string> cells = record(text, at, line, name);
    if (cells.size() == 1 && cells[0].empty()) continue;  // an empty line
    if (cells.size() != table.columns.size())
      throw UserError({name, first},
                      fmt::format("this row has {} cells, expected {}", cells.size(), table.columns.size()));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace glint::report
