// Writing the HTML report.
// SPDX-License-Identifier: Apache-2.0
#include "report/page.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

#include "report/base64.h"
#include "report/image_files.h"
#include "report/page_parts.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

std::string title_of(const Json& run) {
  const Json& facts = run["run"];
  const std::string scene = facts["scene"].value("name", ""), shader = facts.value("shader", "");
  return shader.empty() || shader == scene ? scene : scene + " " + shader;
}

// Text of a description, in which words between backquotes are code.
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

// A value with thin spaces between thousands, whole from 1000 on, four digits below.
std::string shown(const Json& value) {
  if (value.is_null()) return "–";
  if (value.is_string()) return escaped(value.get<std::string>());
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  const double number = value.get<double>();
  if ((std::floor(number) != number && std::abs(number) < 1000) || std::abs(number) > 9e15) return fmt::format("{:.4g}", number);
  const std::string digits = fmt::format("{:.0f}", std::abs(number));
  std::string out = number < 0 ? "−" : "";
  for (size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) out += "\u202f";
    out += digits[i];
  }
  return out;
}

// "ship8" of "out/ship8/"
std::string folder_of(const Json& run) {
  const std::filesystem::path path = run["directory"].get<std::string>();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

std::string header_row(const Json& runs, std::string_view first) {
  std::string out = fmt::format("<thead><tr><th scope=\"col\">{}</th>", first);
  if (runs.size() == 1) return out + "<th scope=\"col\" class=\"n\">Value</th>";
  for (const Json& run : runs)
    out += fmt::format("<th scope=\"col\" class=\"n\" title=\"{}\">{}<small>{}</small><small>{}</small></th>", escaped(run["directory"].get<std::string>()), escaped(title_of(run)),
                       escaped(run["run"]["config"].value("name", "")), escaped(folder_of(run)));
  return out;
}

std::string metrics_table(const Json& data) {
  const Json& runs = data["runs"];
  std::string out = "<div class=\"scroll\"><table class=\"metrics\">" + header_row(runs, "Metric") + "<th scope=\"col\">Unit</th><th scope=\"col\">Meaning</th></tr></thead>\n";
  std::string group;
  for (const Json& metric : data["metric_docs"]) {
    if (!metric["known"].get<bool>()) continue;
    const std::string name = metric["name"], unit = metric["unit"], doc = metric["doc"];
    if (metric["group"] != group) {
      group = metric["group"];
      out += fmt::format("<tbody><tr class=\"group\"><th scope=\"rowgroup\" colspan=\"{}\">{}</th></tr>\n", runs.size() + 3, escaped(group));
    }
    out += fmt::format("<tr><th scope=\"row\"><code>{}</code></th>", escaped(name));
    for (const Json& run : runs) out += fmt::format("<td class=\"n\">{}</td>", shown(run["metrics"][name]));
    out += fmt::format("<td class=\"u\">{}</td><td class=\"doc\">{}</td></tr>\n", escaped(unit), prose(doc));
  }
  return out + "</table></div>";
}

// Every key that differs from a run's preset, with the value of each run.
std::string config_table(const Json& data) {
  const Json& runs = data["runs"];
  std::string rows;
  for (const auto& [key, doc] : data["key_docs"].items()) {
    bool is_changed = false;
    std::string cells;
    for (const Json& run : runs) {
      const Json& changes = run["preset"]["changes"];
      const Json value = run["config"].value(key, Json());
      if (!changes.contains(key)) {
        cells += fmt::format("<td class=\"n\">{}</td>", shown(value));
        continue;
      }
      is_changed = true;
      cells += fmt::format("<td class=\"n changed\">{}<small>preset {}</small></td>", shown(value), shown(changes[key]));
    }
    if (is_changed) rows += fmt::format("<tr><th scope=\"row\"><code>{}</code></th>{}<td class=\"u\">{}</td><td class=\"doc\">{}</td></tr>\n", escaped(key), cells, escaped(doc["unit"].get<std::string>()), prose(doc["doc"].get<std::string>()));
  }
  std::string out;
  for (const Json& run : runs) {
    if (run["preset"]["known"].get<bool>()) continue;
    out += fmt::format("<p class=\"note\">{}: {}</p>\n", escaped(run["directory"].get<std::string>()), escaped(run["preset"]["note"].get<std::string>()));
  }
  if (rows.empty()) return out + "<p>Every key has its preset’s value.</p>\n";
  return out + "<div class=\"scroll\"><table class=\"config\">" + header_row(runs, "Key") + "<th scope=\"col\">Unit</th><th scope=\"col\">Meaning</th></tr></thead><tbody>\n" + rows + "</tbody></table></div>\n";
}

std::string pictures(const Json& data) {
  std::string out;
  for (const Json& run : data["runs"])
    if (run.contains("picture"))
      out += fmt::format("<figure><img alt=\"\" src=\"{}\"><figcaption>{}</figcaption></figure>\n", run["picture"].get<std::string>(), escaped(title_of(run)));
  return out;
}

// The script packed, under its notices, which stay readable, and what unpacks it.
std::string script_of(const PageParts& parts) {
  if (parts.unpack.empty()) return "<script>\n" + parts.script + "</script>";
  const size_t end = parts.script.starts_with("/*!") ? parts.script.find("*/") + 2 : 0;
  const std::string rest = parts.script.substr(end);
  return fmt::format("<script>\n{}\n</script>\n<script type=\"text/plain\" id=\"packed\" data-bytes=\"{}\">{}</script>\n<script>\n{}</script>", parts.script.substr(0, end), rest.size(),
                     base64(zlib_bytes(rest)), parts.unpack);
}

}  // namespace

std::string page(const nlohmann::ordered_json& data, const PageParts& parts) {
  const Json& runs = data["runs"];
  const std::string title = runs.size() == 1 ? title_of(runs[0]) : fmt::format("{} runs", runs.size());
  std::string out = parts.frame;
  // The script goes in last: no mark is searched in it.
  place(out, "<!--title-->", escaped(title) + " – Glint report");
  place(out, "<!--style-->", "<style>\n" + parts.style + "</style>");
  place(out, "<!--noscript-->", fmt::format("<noscript><h1>{}</h1>\n{}<p class=\"note\">The figures need a browser that runs scripts. The tables below do not.</p></noscript>", escaped(title), pictures(data)));
  place(out, "<!--changes-->", config_table(data));
  place(out, "<!--metrics-->", metrics_table(data));
  place(out, "<!--script-->", script_of(parts));
  place(out, "<!--data-->", "<script type=\"application/json\" id=\"data\">" + script_json(data) + "</script>");
  return out;
}

}  // namespace glint::report
