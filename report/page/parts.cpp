// Escapes for HTML, packs, and fills in a page's frame.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/parts.h"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/diagnostics.h"
#include "report/files/base64.h"
#include "report/files/gzip.h"

namespace glint::report {

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

std::string escaped_text(const nlohmann::ordered_json& object, const char* key) {
  return escaped(object.at(key).get<std::string>());
}

std::string prose(std::string_view text) {
  std::string out;
  bool in_code = false;
  for (const char c : escaped(text)) {
    if (c != '`') {
      out += c;
      continue;
    }
    out += in_code ? "</code>" : "<code>";
    in_code = !in_code;
  }
  return in_code ? escaped(text) : out;
}

std::string shown(const nlohmann::ordered_json& value) {
  if (value.is_null()) return "–";
  if (value.is_string()) return escaped(value.get<std::string>());
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  const double number = value.get<double>();
  if ((std::floor(number) != number && std::abs(number) < 1000) || std::abs(number) > 9e15)
    return fmt::format("{:.4g}", number);
  const std::string digits = fmt::format("{:.0f}", std::abs(number));
  std::string out = number < 0 ? "−" : "";
  for (size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) out += "\u202f";
    out += digits[i];
  }
  return out;
}

std::string packed_element(std::string_view id, std::string_view text) {
  return fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>", id, base64(zlib_bytes(text)));
}

void place(std::string& page, std::string_view mark, const std::string& text) {
  const size_t at = page.find(mark);
  if (at == std::string::npos)
    throw UserError({"web/dist"}, fmt::format("a page's frame has no place {}", mark),
                    "Glint's own files are incomplete: install it again");
  page.replace(at, mark.size(), text);
}

}  // namespace glint::report
