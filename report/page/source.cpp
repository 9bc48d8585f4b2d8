// Writes listings and counts for the report.
// SPDX-License-Identifier: Apache-2.0
#include "report/page/source.h"

#include <cstdint>
#include <nlohmann/json.hpp>

#include "base/diagnostics.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

Json columns_of(const std::vector<ListedLine>& lines, size_t first, bool is_isa) {
  Json text = Json::array(), file = Json::array(), line = Json::array(), spirv = Json::array(),
       scope = Json::array();
  for (size_t i = first; i < lines.size(); ++i) {
    text.push_back(lines[i].text);
    file.push_back(lines[i].file);
    line.push_back(lines[i].line);
    spirv.push_back(lines[i].spirv);
    scope.push_back(lines[i].scope);
  }
  Json out = {{"text", text}, {"file", file}, {"line", line}};
  if (is_isa)
    out["spirv"] = spirv, out["scope"] = scope;
  else
    out["first"] = first + 1;
  return out;
}

// Returns where the first function begins. What comes before it is declared and costs nothing.
size_t first_function(const ProgramListing& program) {
  for (size_t i = 0; i < program.spirv.size(); ++i)
    if (program.spirv[i].text.find("= OpFunction ") != std::string::npos) return i;
  return program.spirv.size();
}

Json program_of(const ProgramListing& program) {
  Json scopes = Json::array();
  for (const ListedScope& scope : program.scopes)
    scopes.push_back({scope.function, scope.caller, scope.file, scope.line});
  return {{"shader", program.shader},
          {"stage", program.stage},
          {"scopes", scopes},
          {"isa", columns_of(program.isa, 0, true)},
          {"spirv", columns_of(program.spirv, first_function(program), false)}};
}

Json packed_counts(const ProfileRow& row) {
  Json out = {row.program, row.index,    row.issues, row.lanes,
              row.sectors, row.accesses, row.ended,  row.latency};
  for (size_t i = 0; i < row.slots.size(); ++i)
    if (row.slots[i]) out.push_back(i), out.push_back(row.slots[i]);
  return out;
}

}  // namespace

Json page_source(const ProfileTable& profile, const SourceMap& map) {
  Json files = Json::array(), programs = Json::array(), counts = Json::array();
  for (const SourceFile& file : map.files)
    files.push_back({{"path", file.path}, {"text", file.is_known ? Json(file.lines) : Json(nullptr)}});
  for (const ProgramListing& program : map.programs) programs.push_back(program_of(program));
  uint64_t no_warp = 0;
  for (const ProfileRow& row : profile.rows) {
    if (row.shader.empty()) {
      no_warp += row.total();
      continue;
    }
    if (row.program >= map.programs.size() || row.index >= map.programs[row.program].isa.size())
      throw UserError({}, "profile.csv and source.json of the run do not belong together",
                      "run it again with --profile");
    counts.push_back(packed_counts(row));
  }
  return {{"reasons", profile.reasons},
          {"files", files},
          {"programs", programs},
          {"counts", counts},
          {"no_warp", no_warp}};
}

}  // namespace glint::report
