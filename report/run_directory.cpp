// Writing of run directories.
// SPDX-License-Identifier: Apache-2.0
#include "report/run_directory.h"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <unistd.h>

#include "base/diagnostics.h"
#include "report/config_file.h"
#include "report/stat_writer.h"

namespace glint::report {
namespace fs = std::filesystem;

RunDirectory::RunDirectory(std::string path) : path_(std::move(path)) {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error || !fs::is_directory(path_, error))
    throw UserError({path_}, "cannot create the output folder", "give another one with --out");
}

void RunDirectory::remove(const std::string& name) const {
  std::error_code error;
  fs::remove_all(path_of(name), error);
  if (error) throw UserError({path_of(name)}, "cannot remove what an earlier run left: " + error.message());
}

void RunDirectory::write(const std::string& name, const std::string& bytes) const {
  if (name.find('/') != std::string::npos) {
    std::error_code error;
    fs::create_directories(fs::path(path_of(name)).parent_path(), error);
    if (error) throw UserError({path_of(name)}, "cannot create its folder: " + error.message());
  }
  // The process id keeps two runs into one folder from writing the same temporary file.
  const std::string target = path_of(name), temporary = fmt::format("{}.{}.tmp", target, ::getpid());
  {
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    out.write(bytes.data(), std::streamsize(bytes.size()));
    out.flush();
    if (!out)
      throw UserError({target}, "cannot write the file", "is the disk full, or the folder read-only?");
  }
  std::error_code error;
  fs::rename(temporary, target, error);
  if (error) throw UserError({target}, "cannot write the file: " + error.message());
}

void RunDirectory::write_image(const ImageView& image) const {
  write("image.png", png_bytes(image));
  write("image.pfm", pfm_bytes(image));
}

void RunDirectory::write_stats(const stats::Group& root) const {
  for (const auto& [name, entry] : Registry<StatWriter>::instance().entries())
    write("stats." + std::string(name), entry.make_default({})->write(root));
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
  json["width"] = info.width;
  json["height"] = info.height;
  json["samples"] = info.samples;
  json["seed"] = info.seed;
  if (info.bounces > 0) json["rays"] = {{"bounces", info.bounces}, {"shadow_rays", info.shadow_rays}, {"ao_rays", info.ao_rays}};
  if (const auto& s = info.structures)
    json["structures"] = {{"bytes", s->bytes},         {"triangles", s->triangles}, {"procedurals", s->procedurals},  {"bottom_levels", s->bottom_levels},
                          {"instances", s->instances}, {"top_depth", s->top_depth}, {"bottom_depth", s->bottom_depth}};
  if (const auto& r = info.residency) json["residency"] = {{"warps", r->warps}, {"blocks", r->blocks}, {"limit", r->limit}};
  json["started"] = info.started;
  json["wall_seconds"] = info.wall_seconds;
  json["on_fault"] = info.on_fault;
  if (!info.faults.empty()) json["faults"] = nlohmann::ordered_json::array();
  for (const FaultInfo& fault : info.faults)
    json["faults"].push_back({{"kind", fault.kind}, {"place", fault.place}, {"what", fault.what}, {"launch_id", fault.launch_id}, {"count", fault.count}});
  json["exit"] = info.exit;
  if (!info.message.empty()) json["message"] = info.message;
  using ErrorHandler = nlohmann::ordered_json::error_handler_t;
  write("run.json", json.dump(2, ' ', false, ErrorHandler::replace) + "\n");  // argv need not be UTF-8
}

}  // namespace glint::report
