// Writes run directories.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/run_directory.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <unistd.h>

#include "base/diagnostics.h"
#include "report/files/config_file.h"
#include "report/files/stat_writer.h"

namespace glint::report {
namespace fs = std::filesystem;

namespace {

// Returns the pointer of a key: "rays.bounces" is the entry "bounces" of the table "rays".
nlohmann::ordered_json::json_pointer pointer_of(std::string key) {
  std::replace(key.begin(), key.end(), '.', '/');
  return nlohmann::ordered_json::json_pointer("/" + key);
}

constexpr const char* kResults[] = {"image.png",      "image.pfm",   "printf.txt", "profile.csv",
                                    "profile.folded", "source.json", "series.csv", "trace.json.gz"};
constexpr const char* kFolder = "heat";  // the only folder of a run

bool put(const std::string& path, const std::string& bytes) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), std::streamsize(bytes.size()));
  out.close();
  return bool(out);
}

// Returns what the run of that run.json has saved. It returns only names in the run's folder, whatever the
// file says.
std::vector<std::string> saved_before(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
  std::vector<std::string> out;
  if (!json.is_object() || !json.contains("saved") || !json["saved"].is_array()) return out;
  for (const nlohmann::json& name : json["saved"])
    if (name.is_string() && name != "." && name != ".." && !name.get<std::string>().empty() &&
        name.get<std::string>().find('/') == std::string::npos)
      out.push_back(name);
  return out;
}

}  // namespace

void write_file(const std::string& path, const std::string& bytes) {
  constexpr const char* kHint = "is the disk full, or the folder read-only?";
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error)) {
    if (!put(path, bytes)) throw UserError({path}, "cannot write the file", kHint);
    return;
  }
  const std::string target = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error).string() : path;
  // The process id in the name keeps two processes from writing the same temporary file.
  const std::string temporary = fmt::format("{}.{}.tmp", target, ::getpid());
  const bool is_whole = put(temporary, bytes);
  if (is_whole) fs::rename(temporary, target, error);
  if (is_whole && !error) return;
  std::error_code ignored;
  fs::remove(temporary, ignored);
  throw UserError({path}, "cannot write the file" + (is_whole ? ": " + error.message() : ""), kHint);
}

RunDirectory::RunDirectory(std::string path) : path_(std::move(path)) {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error || !fs::is_directory(path_, error))
    throw UserError({path_}, "cannot create the output folder", "name another folder with --out");
}

void RunDirectory::remove(const std::string& name) const {
  std::error_code error;
  if (name != kFolder && fs::is_directory(fs::symlink_status(path_of(name), error)))
    throw UserError({path_of(name)}, "a folder stands where a run has a file",
                    "move it away, or name another folder with --out");
  fs::remove_all(path_of(name), error);
  if (error) throw UserError({path_of(name)}, "cannot remove what an earlier run left: " + error.message());
}

void RunDirectory::write(const std::string& name, const std::string& bytes) const {
  if (name.find('/') != std::string::npos) {
    std::error_code error;
    fs::create_directories(fs::path(path_of(name)).parent_path(), error);
    if (error) throw UserError({path_of(name)}, "cannot create its folder: " + error.message());
  }
  write_file(path_of(name), bytes);
}

void RunDirectory::remove_results(const std::vector<std::string>& saved) const {
  std::vector<std::string> names = saved_before(path_of("run.json"));
  names.insert(names.end(), saved.begin(), saved.end());
  for (const std::string& format : Registry<StatWriter>::names()) names.push_back("stats." + format);
  names.insert(names.end(), std::begin(kResults), std::end(kResults));
  names.push_back(kFolder);
  remove("run.json");
  for (const std::string& name : names) remove(name);
}

void RunDirectory::write_image(const ImageView& image) const {
  write("image.png", png_bytes(image));
  write("image.pfm", pfm_bytes(image));
}

void RunDirectory::write_stats(const stats::Group& root) const {
  for (const std::string& format : Registry<StatWriter>::names())
    write("stats." + format, Registry<StatWriter>::instance().entry(format).make_default({})->write(root));
}

void RunDirectory::write_config(const std::vector<ParamInfo>& params, const std::string& title) const {
  write("config.toml", config_file(params, title));
}

void RunDirectory::write_run(const RunInfo& info) const {
  nlohmann::ordered_json json;
  json["schema"] = kRunSchema;
  json["command"] = info.command;
  json["version"] = info.version;
  json["git"] = info.git;
  json["compiler"] = info.compiler;
  for (const auto& [file, hash] : info.plugins) json["plugins"][file] = hash;
  json["scene"] = {{"name", info.scene},
                   {"form", info.scene_form},
                   {"note", info.scene_note},
                   {"hash", fmt::format("{:016x}", info.scene_hash)},
                   {"triangles", info.scene_triangles},
                   {"fraction", info.scene_fraction}};
  json["shader"] = info.shader;
  json["config"] = {{"name", info.config}, {"hash", fmt::format("{:016x}", info.config_hash)}};
  for (const auto& [name, value] : info.memory_peaks) json["memory_peaks"][name] = value;
  json["mode"] = info.mode;
  for (const auto& [key, value] : info.frame) json[pointer_of(key)] = value;
  if (const auto& s = info.structures)
    json["structures"] = {{"bytes", s->bytes},
                          {"triangles", s->triangles},
                          {"procedurals", s->procedurals},
                          {"bottom_levels", s->bottom_levels},
                          {"instances", s->instances},
                          {"top_depth", s->top_depth},
                          {"bottom_depth", s->bottom_depth}};
  if (const auto& r = info.residency)
    json["residency"] = {{"warps", r->warps}, {"blocks", r->blocks}, {"limit", r->limit}};
  json["started"] = info.started;
  json["wall_seconds"] = info.wall_seconds;
  json["on_fault"] = info.on_fault;
  if (!info.faults.empty()) json["faults"] = nlohmann::ordered_json::array();
  for (const FaultInfo& fault : info.faults)
    json["faults"].push_back({{"kind", fault.kind},
                              {"place", fault.place},
                              {"what", fault.what},
                              {"launch_id", fault.launch_id},
                              {"count", fault.count}});
  if (!info.saved.empty()) json["saved"] = info.saved;
  json["exit"] = info.exit;
  if (!info.message.empty()) json["message"] = info.message;
  using ErrorHandler = nlohmann::ordered_json::error_handler_t;
  write("run.json", json.dump(2, ' ', false, ErrorHandler::replace) + "\n");  // argv may be other than UTF-8
}

}  // namespace glint::report
