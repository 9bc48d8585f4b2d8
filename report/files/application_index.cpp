// Describes what an application did on a device of the Vulkan driver: its index.json.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/application_index.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/diagnostics.h"
#include "base/regular_file.h"
#include "report/files/run_facts.h"

namespace glint::report {
namespace {

using Json = nlohmann::ordered_json;

// Names of shaders and labels come from applications, and may be other than UTF-8.
std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json json_of(const std::vector<NotDone>& list) {
  Json out = Json::array();
  for (const NotDone& each : list)
    out.push_back({{"what", each.what}, {"why", each.why}, {"count", each.count}});
  return out;
}

std::string path_of(const std::string& folder) {
  return folder + "/" + kApplicationIndex;
}

bool is_command(const Json& json) {
  const auto is_number = [&](const char* key) {
    return json.contains(key) && json[key].is_number_unsigned();
  };
  const auto is_text = [&](const char* key) { return json.contains(key) && json[key].is_string(); };
  if (!json.is_object() || !is_text("kind") || !is_number("begin") || !is_number("end")) return false;
  if (json["kind"] == "transfer") return is_number("count") && is_number("bytes");
  if (json["kind"] == "build")
    return is_number("frame") && is_text("structure") && is_text("level") && is_number("primitives") &&
           is_number("bytes");
  const bool has_size = json.contains("size") && json["size"].is_array() &&
                        std::all_of(json["size"].begin(), json["size"].end(),
                                    [](const Json& one) { return one.is_number_unsigned(); });
  if (!has_size || !is_number("frame")) return false;
  if (json["kind"] == "present")
    return (!json.contains("file") || is_text("file")) && (!json.contains("dropped") || is_number("dropped"));
  return is_number("number") && is_text("shader") && is_text("label") && is_number("instructions") &&
         is_number("faults") && json.contains("cycles") &&
         (json["cycles"].is_null() || json["cycles"].is_number_unsigned());
}

bool is_not_done(const Json& json) {
  return json.is_array() && std::all_of(json.begin(), json.end(), [](const Json& one) {
           return one.is_object() && one.contains("what") && one["what"].is_string() && one.contains("why") &&
                  one["why"].is_string() && one.contains("count") && one["count"].is_number_unsigned();
         });
}

}  // namespace

void ApplicationIndex::add(const DeviceCommand& command) {
  Json json = {{"kind", command.kind}};
  if (command.kind == "transfer") {
    json.update({{"count", command.count}, {"bytes", command.bytes}});
  } else if (command.kind == "present") {
    json.update({{"frame", command.frame}, {"size", {command.size[0], command.size[1]}}});
    if (!command.file.empty()) json["file"] = command.file;
    if (command.dropped) json["dropped"] = command.dropped;
  } else if (command.kind == "build") {
    json.update({{"frame", command.frame},
                 {"structure", command.structure},
                 {"level", command.is_top ? "top" : "bottom"},
                 {"primitives", command.count},
                 {"bytes", command.bytes},
                 {"by", command.on_host ? "host" : "device"},
                 {"update", command.is_update}});
  } else {
    json.update({{"number", command.number},
                 {"frame", command.frame},
                 {"shader", command.shader},
                 {"label", command.label},
                 {"size", command.size},
                 {"instructions", command.instructions},
                 {"cycles", command.cycles ? Json(*command.cycles) : Json(nullptr)},
                 {"faults", command.faults}});
    if (!command.folder.empty()) json["folder"] = command.folder;
    if (!command.error.empty()) json["error"] = command.error;
  }
  json.update({{"begin", command.begin}, {"end", command.end}});
  commands_ += (size_++ ? ",\n" : "\n") + text_of(json);
}

std::string ApplicationIndex::text(const ApplicationFacts& facts) const {
  const Json head = {{"schema", kApplicationSchema},
                     {"program", facts.program},
                     {"command", facts.command},
                     {"version", facts.version},
                     {"git", facts.git},
                     {"config", facts.config},
                     {"clock_mhz", facts.clock_mhz},
                     {"timing", facts.timing},
                     {"process", facts.process},
                     {"started", facts.started},
                     {"state", facts.has_ended ? "ended" : "running"},
                     {"dropped", json_of(facts.dropped)},
                     {"refused", json_of(facts.refused)}};
  std::string out = head.dump(2, ' ', false, Json::error_handler_t::replace);
  out.erase(out.rfind('\n'));  // "\n}"
  return out + ",\n  \"commands\": [" + commands_ + "\n]}\n";
}

bool is_launch(const Json& command) {
  return command.contains("number");
}

bool is_application_folder(const std::string& folder) {
  std::error_code error;
  return std::filesystem::is_regular_file(path_of(folder), error);
}

Json read_application(const std::string& folder) {
  const std::string path = path_of(folder);
  const std::optional<std::string> text = read_regular_file(path);
  if (!text) throw UserError({path}, "cannot read the file");
  Json json = json_object(*text, path);
  if (json.value("schema", Json()) != kApplicationSchema)
    throw UserError({path},
                    fmt::format("it is no index of an application with schema {}", kApplicationSchema),
                    "another version of Glint wrote it: run the application again with this one");
  for (const char* key : {"program", "config", "timing", "started", "state"})
    if (!json.contains(key) || !json[key].is_string())
      throw UserError({path}, fmt::format("there is no '{}'", key), "the file is damaged");
  for (const char* key : {"dropped", "refused"})
    if (!json.contains(key) || !is_not_done(json[key]))
      throw UserError({path}, fmt::format("there is no list '{}'", key), "the file is damaged");
  if (!json.contains("commands") || !json["commands"].is_array() ||
      !std::all_of(json["commands"].begin(), json["commands"].end(), is_command))
    throw UserError({path}, "its commands are not what a driver writes", "the file is damaged");
  return json;
}

}  // namespace glint::report
