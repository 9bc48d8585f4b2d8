// Checks run.json as it is read.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/run_facts.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/diagnostics.h"
#include "base/regular_file.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

struct Fact {
  const char *pointer, *type;  // The types are those of Json::type_name().
};
constexpr Fact kFacts[] = {{"/schema", "number"},
                           {"/command", "array"},
                           {"/version", "string"},
                           {"/git", "string"},
                           {"/compiler", "string"},
                           {"/plugins", "object"},
                           {"/scene", "object"},
                           {"/scene/name", "string"},
                           {"/scene/form", "string"},
                           {"/scene/note", "string"},
                           {"/scene/hash", "string"},
                           {"/scene/file", "string"},
                           {"/scene/triangles", "number"},
                           {"/scene/fraction", "number"},
                           {"/shader", "string"},
                           {"/config", "object"},
                           {"/config/name", "string"},
                           {"/config/hash", "string"},
                           {"/memory_peaks", "object"},
                           {"/mode", "string"},
                           {"/width", "number"},
                           {"/height", "number"},
                           {"/samples", "number"},
                           {"/seed", "number"},
                           {"/structures", "object"},
                           {"/structures/bytes", "number"},
                           {"/residency", "object"},
                           {"/residency/warps", "number"},
                           {"/residency/blocks", "number"},
                           {"/residency/limit", "string"},
                           {"/started", "string"},
                           {"/wall_seconds", "number"},
                           {"/on_fault", "string"},
                           {"/faults", "array"},
                           {"/statistics", "string"},
                           {"/not_finite", "object"},
                           {"/saved", "array"},
                           {"/files", "object"},
                           {"/sample", "object"},
                           {"/sample/share", "number"},
                           {"/sample/seed", "number"},
                           {"/sample/by", "string"},
                           {"/sample/scale", "number"},
                           {"/sample/blocks", "number"},
                           {"/sample/timed", "number"},
                           {"/sample/warm", "number"},
                           {"/sample/launches", "number"},
                           {"/sample/clusters", "number"},
                           {"/partial", "object"},
                           {"/partial/reason", "string"},
                           {"/partial/cycles", "number"},
                           {"/partial/ended_warps", "number"},
                           {"/partial/num_warps", "number"},
                           {"/partial/where", "string"},
                           {"/exit", "number"},
                           {"/message", "string"}};

void check_types(const Json& facts, const std::string& path) {
  for (const Fact& fact : kFacts) {
    const Json::json_pointer pointer(fact.pointer);
    if (!facts.contains(pointer) || std::string(facts[pointer].type_name()) == fact.type) continue;
    throw UserError({path},
                    fmt::format("'{}' is {}, expected {}", std::string(fact.pointer).substr(1),
                                facts[pointer].type_name(), fact.type),
                    "the file is damaged; run it again");
  }
}

}  // namespace

Json json_object(const std::string& text, const std::string& path) {
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_object())
    throw UserError({path}, "this is not a JSON object", "the file is damaged; run it again");
  return json;
}

Json read_run_facts(const std::string& path) {
  const std::optional<std::string> text = read_regular_file(path);
  if (!text) throw UserError({path}, "cannot read the file", "is this the directory of a finished run?");
  Json facts = json_object(*text, path);
  check_types(facts, path);
  return facts;
}

bool is_run_folder(const std::string& folder) {
  const std::optional<std::string> text = read_regular_file(folder + "/run.json");
  if (!text) return false;
  const Json facts = Json::parse(*text, nullptr, false);
  return facts.is_object() && facts.contains("schema") && facts["schema"].is_number() &&
         facts.contains("command") && facts["command"].is_array() && facts.contains("version") &&
         facts["version"].is_string();
}

}  // namespace glint::report
