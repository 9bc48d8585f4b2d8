// Writes and reads source.json.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/source_files.h"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/diagnostics.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSourceSchema = 1;
constexpr const char* kAdvice =
    "another version of Glint wrote it, or it is damaged: run it again with --profile";

// Returns lines as columns, so that the document is short and packs well.
Json columns_of(const std::vector<ListedLine>& lines, bool is_isa) {
  Json text = Json::array(), file = Json::array(), line = Json::array(), spirv = Json::array(),
       scope = Json::array();
  for (const ListedLine& each : lines) {
    text.push_back(each.text);
    file.push_back(each.file);
    line.push_back(each.line);
    spirv.push_back(each.spirv);
    scope.push_back(each.scope);
  }
  Json out = {{"text", text}, {"file", file}, {"line", line}};
  if (is_isa) out["spirv"] = spirv, out["scope"] = scope;
  return out;
}

std::vector<ListedLine> lines_of(const Json& columns, bool is_isa) {
  std::vector<ListedLine> out;
  for (const Json& text : columns.at("text")) {
    const size_t i = out.size();
    ListedLine line{text.get<std::string>(), columns.at("file").at(i).get<uint16_t>(),
                    columns.at("line").at(i).get<uint32_t>(), 0, 0};
    if (is_isa)
      line.spirv = columns.at("spirv").at(i).get<uint32_t>(),
      line.scope = columns.at("scope").at(i).get<uint32_t>();
    out.push_back(std::move(line));
  }
  return out;
}

ProgramListing program_of(const Json& from) {
  ProgramListing out;
  out.shader = from.at("shader").get<std::string>();
  out.stage = from.at("stage").get<std::string>();
  out.isa = lines_of(from.at("isa"), true);
  out.spirv = lines_of(from.at("spirv"), false);
  for (const Json& scope : from.at("scopes"))
    out.scopes.push_back({scope.at("function").get<std::string>(), scope.at("caller").get<uint32_t>(),
                          scope.at("file").get<uint16_t>(), scope.at("line").get<uint32_t>()});
  return out;
}

// Returns whether all numbers name something.
bool is_whole(const SourceMap& map) {
  const auto fits = [&](const ListedLine& line, const ProgramListing& program) {
    return (line.line == 0 || line.file < map.files.size()) && line.spirv <= program.spirv.size() &&
           line.scope <= program.scopes.size();
  };
  for (const ProgramListing& program : map.programs) {
    for (const auto* lines : {&program.isa, &program.spirv})
      for (const ListedLine& line : *lines)
        if (!fits(line, program)) return false;
    for (size_t i = 0; i < program.scopes.size(); ++i)
      if (program.scopes[i].caller > i ||
          (program.scopes[i].caller != 0 && program.scopes[i].file >= map.files.size()))
        return false;
  }
  return true;
}

}  // namespace

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    std::string& line = out.emplace_back();
    for (; at < end; ++at) {
      if (text[at] == '\t')
        line += "    ";
      else if (text[at] != '\r')
        line += text[at];
    }
    at = end + 1;
  }
  return out;
}

SourceMap source_map(const std::vector<ProgramListing>& programs, const TextOf& text_of) {
  SourceMap out;
  std::map<std::string, uint16_t> numbers;
  for (const ProgramListing& program : programs) {
    std::vector<uint16_t> moved;
    for (const std::string& path : program.files) {
      const auto [at, is_new] = numbers.try_emplace(path, uint16_t(out.files.size()));
      moved.push_back(at->second);
      if (!is_new) continue;
      const std::optional<std::string> text = text_of(path);
      out.files.push_back({path, text.has_value(), text ? lines_of(*text) : std::vector<std::string>()});
    }
    const auto renumber = [&](auto& row) {
      row.file = row.file < moved.size() ? moved[row.file] : uint16_t{0};
    };
    ProgramListing& copy = out.programs.emplace_back(program);
    copy.files.clear();
    for (auto* lines : {&copy.isa, &copy.spirv})
      for (ListedLine& line : *lines) renumber(line);
    for (ListedScope& scope : copy.scopes) renumber(scope);
  }
  return out;
}

std::string source_json(const SourceMap& map) {
  Json files = Json::array(), programs = Json::array();
  for (const SourceFile& file : map.files)
    files.push_back({{"path", file.path}, {"text", file.is_known ? Json(file.lines) : Json(nullptr)}});
  for (const ProgramListing& program : map.programs) {
    Json scopes = Json::array();
    for (const ListedScope& scope : program.scopes)
      scopes.push_back({{"function", scope.function},
                        {"caller", scope.caller},
                        {"file", scope.file},
                        {"line", scope.line}});
    programs.push_back({{"shader", program.shader},
                        {"stage", program.stage},
                        {"isa", columns_of(program.isa, true)},
                        {"spirv", columns_of(program.spirv, false)},
                        {"scopes", scopes}});
  }
  const Json out = {{"schema", kSourceSchema}, {"files", files}, {"programs", programs}};
  return out.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

SourceMap parse_source(const std::string& text, const std::string& name) {
  const Json document = Json::parse(text, nullptr, false);
  const bool is_known =
      document.is_object() && document.contains("schema") && document["schema"] == kSourceSchema;
  if (!is_known)
    throw UserError({name}, fmt::format("this is not a source document of schema {}", kSourceSchema),
                    kAdvice);
  SourceMap out;
  try {
    for (const Json& file : document.at("files")) {
      const Json& lines = file.at("text");
      out.files.push_back(
          {file.at("path").get<std::string>(), !lines.is_null(),
           lines.is_null() ? std::vector<std::string>() : lines.get<std::vector<std::string>>()});
    }
    for (const Json& program : document.at("programs")) out.programs.push_back(program_of(program));
  } catch (const nlohmann::json::exception& error) {
    throw UserError({name}, fmt::format("the source document is incomplete: {}", error.what()), kAdvice);
  }
  if (!is_whole(out))
    throw UserError({name}, "a line of the source document names what is not there", kAdvice);
  return out;
}

}  // namespace glint::report
