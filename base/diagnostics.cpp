// Formats and collects diagnostics.
// SPDX-License-Identifier: Apache-2.0
#include "base/diagnostics.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <numeric>

#include "base/check.h"

namespace glint {
namespace {

std::string format_message(const SourceLocation& where, const char* severity, const std::string& what,
                           const std::string& note) {
  const std::string place = where.to_string();
  std::string text = place.empty() ? fmt::format("{}: {}", severity, what)
                                   : fmt::format("{}: {}: {}", place, severity, what);
  if (!note.empty()) text += "\n  note: " + note;
  return text;
}

size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t above = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

std::string SourceLocation::to_string() const {
  if (file.empty()) return {};
  std::string text = file;
  if (line > 0) text += fmt::format(":{}", line);
  if (line > 0 && column > 0) text += fmt::format(":{}", column);
  return text;
}

UserError::UserError(const SourceLocation& where, const std::string& what, const std::string& note)
    : Error(Exit::UserInput, format_message(where, "error", what, note)) {
}

void Diagnostics::error(const SourceLocation& where, const std::string& what, const std::string& note) {
  messages_.push_back(format_message(where, "error", what, note));
  ++num_errors_;
}

void Diagnostics::warning(const SourceLocation& where, const std::string& what) {
  messages_.push_back(format_message(where, "warning", what, {}));
}

void Diagnostics::throw_if_errors() const {
  if (!has_errors()) return;
  throw UserError(fmt::format("{}", fmt::join(messages_, "\n")));
}

std::string nearest(const std::string& word, const std::vector<std::string>& candidates) {
  std::string best;
  size_t best_distance = std::max<size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const size_t distance = edit_distance(word, candidate);
    if (distance < best_distance) best = candidate, best_distance = distance;
  }
  return best;
}

void check_failed(const char* file, int line, const std::string& what) {
  std::fprintf(stderr,
               "%s:%d: internal error: %s\nThis is a bug in Glint: please report it with the command line.\n",
               file, line, what.c_str());
  std::abort();
}

}  // namespace glint
