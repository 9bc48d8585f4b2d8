// Reads configuration files back as text.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/config_rows.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <string_view>
#include <utility>

namespace glint::report {
namespace {

std::string trimmed_text(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
  return first == std::string_view::npos ? "" : std::string(text.substr(first, last - first + 1));
}

// Returns the value at the beginning of `text`, and sets where it ends. A string ends at its quote, and
// anything else ends at a comment.
std::string value_of(const std::string& text, size_t& end) {
  if (text.empty() || text.front() != '"') {
    end = std::min(text.find('#'), text.size());
    return trimmed_text(std::string_view(text).substr(0, end));
  }
  std::string out;
  for (end = 1; end < text.size() && text[end] != '"'; ++end) {
    if (text[end] == '\\' && end + 1 < text.size()) ++end;
    out += text[end];
  }
  return out;
}

// Reads a comment of the form "# [unit] doc. (range)".
void read_comment(const std::string& comment, ConfigRow& row) {
  row.doc = trimmed_text(std::string_view(comment).substr(1));
  if (row.doc.empty() || row.doc.front() != '[') return;
  const size_t close = row.doc.find(']');
  if (close == std::string::npos) return;
  row.unit = row.doc.substr(1, close - 1);
  row.doc = trimmed_text(std::string_view(row.doc).substr(close + 1));
}

}  // namespace

std::vector<ConfigRow> config_rows(const std::string& toml) {
  std::vector<ConfigRow> rows;
  std::istringstream in(toml);
  std::string line, table;
  while (std::getline(in, line)) {
    const std::string text = trimmed_text(line);
    if (text.empty() || text.front() == '#') continue;
    if (text.front() == '[') {
      table = text.substr(1, text.find(']') - 1) + ".";
      continue;
    }
    const size_t equals = text.find('=');
    if (equals == std::string::npos) continue;
    const std::string rest = trimmed_text(std::string_view(text).substr(equals + 1));
    ConfigRow row{.key = table + trimmed_text(std::string_view(text).substr(0, equals)),
                  .value = {},
                  .unit = {},
                  .doc = {}};
    size_t end = 0;
    row.value = value_of(rest, end);
    if (const size_t hash = rest.find('#', end); hash != std::string::npos)
      read_comment(rest.substr(hash), row);
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<ConfigChange> config_changes(const std::vector<ConfigRow>& run,
                                         const std::vector<ConfigRow>& preset) {
  std::map<std::string, std::string> there;
  for (const ConfigRow& row : preset) there[row.key] = row.value;
  std::vector<ConfigChange> changes;
  for (const ConfigRow& row : run) {
    const auto found = there.find(row.key);
    if (found == there.end())
      changes.push_back({row, ""});
    else if (found->second != row.value)
      changes.push_back({row, found->second});
  }
  return changes;
}

}  // namespace glint::report
