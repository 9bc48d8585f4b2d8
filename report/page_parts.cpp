// Escaping for HTML, and filling in a page's frame.
// SPDX-License-Identifier: Apache-2.0
#include "report/page_parts.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/diagnostics.h"

namespace glint::report {

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') out += "&amp;";
    else if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '"') out += "&quot;";
    else out += c;
  }
  return out;
}

std::string script_json(const nlohmann::ordered_json& data) {
  const std::string text = data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string out;
  out.reserve(text.size());
  for (const char c : text) out += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return out;
}

void place(std::string& page, std::string_view mark, const std::string& text) {
  const size_t at = page.find(mark);
  if (at == std::string::npos) throw UserError({"web/dist"}, fmt::format("a page's frame has no place {}", mark), "Glint's own files are incomplete: install it again");
  page.replace(at, mark.size(), text);
}

}  // namespace glint::report
