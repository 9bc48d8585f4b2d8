// Writes run directories.
// SPDX-License-Identifier: Apache-2.0
#include "report/files/run_directory.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>
#include <unistd.h>

#include "base/diagnostics.h"
#include "base/regular_file.h"
#include "report/files/config_file.h"
#include "report/files/csv_field.h"
#include "report/files/run_facts.h"
#include "report/files/stat_rows.h"
#include "report/files/stat_writer.h"

namespace glint::report {
namespace fs = std::filesystem;

namespace {

// Returns the pointer of a key: "rays.bounces" is the entry "bounces" of the table "rays".
nlohmann::ordered_json::json_pointer pointer_of(std::string key) {
  std::replace(key.begin(), key.end(), '.', '/');
  return nlohmann::ordered_json::json_pointer("/" + key);
}

constexpr const char* kResults[] = {"image.png",     "image.pfm",      "image.exr",     "printf.txt",
                                    "profile.csv",   "profile.folded", "source.json",   "series.csv",
                                    "trace.json.gz", "sample.csv",     "signatures.csv"};
constexpr const char* kFolder = "heat";  // the only folder of a run
constexpr const char* kUnfinished = "the run has not ended: it still runs, or it was killed";

// Returns why the bytes could not be written. The streams of the library leave the system's reason in errno.
std::error_code put(const std::string& path, const std::string& bytes) {
  errno = 0;
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), std::streamsize(bytes.size())).flush();
  out.close();
  return out ? std::error_code() : std::error_code(errno != 0 ? errno : EIO, std::generic_category());
}

std::string temporary_name(const std::string& file, long process) {
  return fmt::format("{}.{}.tmp", file, process);
}

// Removes from a folder what write_file() has left of files for whose name `is_own` holds, where a process
// was killed that wrote one. The caller holds the lock of the folder.
template <class IsOwn>
void remove_temporaries(const std::string& folder, IsOwn&& is_own) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
    const fs::path name = entry.path().filename();
    if (name.extension() != ".tmp") continue;
    const std::string number = name.stem().extension().string(), file = name.stem().stem().string();
    const long process = std::strtol(number.c_str() + !number.empty(), nullptr, 10);
    if (process > 0 && name == temporary_name(file, process) && is_own(file) &&
        ::kill(pid_t(process), 0) != 0 && errno == ESRCH)
      fs::remove(entry.path(), ignored);
  }
}

// Returns the strings of a list in a JSON file, or none when the file has no such list. It returns only names
// in one folder, whatever the file says. `name_of` finds the name in an item.
template <typename NameOf>
std::vector<std::string> listed_names(const std::string& path, const char* key, NameOf name_of) {
  const nlohmann::json json = nlohmann::json::parse(read_regular_file(path).value_or(""), nullptr, false);
  std::vector<std::string> out;
  if (!json.is_object() || !json.contains(key) || !json[key].is_array()) return out;
  for (const nlohmann::json& item : json[key]) {
    const nlohmann::json name = name_of(item);
    if (name.is_string() && name != "." && name != ".." && !name.get<std::string>().empty() &&
        name.get<std::string>().find('/') == std::string::npos)
      out.push_back(name);
  }
  return out;
}

// Returns what the run of that run.json has saved.
std::vector<std::string> saved_before(const std::string& path) {
  return listed_names(path, "saved", [](const nlohmann::json& item) { return item; });
}

constexpr const char *kLaunchPrefix = "launch-", *kFramePrefix = "frame-";

// Returns the folders that the run.json of a directory lists under a key and whose names begin so.
std::vector<std::string> folders_before(const std::string& directory, const char* key, const char* prefix) {
  std::vector<std::string> out =
      listed_names(directory + "/run.json", key, [](const nlohmann::json& item) { return item; });
  std::erase_if(out, [&](const std::string& name) { return !name.starts_with(prefix); });
  return out;
}

// Returns the names of the maps in a maps.json.
std::vector<std::string> maps_before(const std::string& path) {
  return listed_names(path, "maps", [](const nlohmann::json& item) {
    return item.is_object() && item.contains("name") ? item["name"] : nlohmann::json();
  });
}

nlohmann::ordered_json json_of(const SampleInfo& sample) {
  if (sample.of == SampleInfo::Of::Launches)
    return {{"share", sample.share},
            {"seed", sample.seed},
            {"launches", sample.all},
            {"timed", sample.timed},
            {"clusters", sample.clusters}};
  return {{"share", sample.share}, {"seed", sample.seed},   {"by", sample.by},    {"scale", sample.scale},
          {"blocks", sample.all},  {"timed", sample.timed}, {"warm", sample.warm}};
}

nlohmann::ordered_json json_of(const SequenceInfo& sequence) {
  nlohmann::ordered_json out = {{"first", sequence.first},
                                {"last", sequence.last},
                                {"fps", sequence.fps},
                                {"structures", sequence.structures},
                                {"caches", sequence.caches}};
  if (!sequence.camera_path.empty()) out["camera_path"] = sequence.camera_path;
  if (!sequence.animation.empty()) out["animation"] = sequence.animation;
  return out;
}

// Adds what a run of frames, and a frame of it, say.
void add_frames(const RunInfo& info, nlohmann::ordered_json& json) {
  if (const auto& s = info.sequence) json["sequence"] = json_of(*s);
  if (const auto& m = info.moment) json["moment"] = {{"frame", m->frame}, {"seconds", m->seconds}};
  if (!info.frames.empty()) json["frames"] = info.frames;
}

void add_outputs(const RunInfo& info, nlohmann::ordered_json& json) {
  const bool is_incomplete = info.sample && info.sample->of == SampleInfo::Of::Blocks;
  for (const OutputInfo& output : info.outputs) {
    nlohmann::ordered_json& one = json["outputs"][output.file];
    one = {{"name", output.name}, {"kind", output.is_image ? "image" : "buffer"}};
    if (is_incomplete) one["incomplete"] = true;
  }
}

nlohmann::ordered_json json_of(const PartInfo& part) {
  return {{"reason", part.reason},
          {"cycles", part.cycles},
          {"ended_warps", part.ended_warps},
          {"num_warps", part.num_warps},
          {"where", part.where}};
}

}  // namespace

void write_file(const std::string& path, const std::string& bytes) {
  const auto fail = [&path](const std::error_code& why) {
    throw UserError({path}, "cannot write the file: " + why.message(),
                    "is the disk full, is there a limit on the size of files, or is the folder read-only?");
  };
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error)) {
    if (const std::error_code why = put(path, bytes)) fail(why);
    return;
  }
  const std::string target = fs::is_symlink(path, error) ? fs::weakly_canonical(path, error).string() : path;
  // The process id in the name keeps two processes from writing the same temporary file.
  const std::string temporary = temporary_name(target, ::getpid());
  std::error_code why = put(temporary, bytes), ignored;
  if (!why) fs::rename(temporary, target, why);
  if (!why) return;
  fs::remove(temporary, ignored);
  fail(why);
}

std::string launch_folder(size_t number, const std::string& name) {
  return fmt::format("{}{}-{}", kLaunchPrefix, number, name);
}

std::vector<std::string> launches_of(const std::string& directory) {
  return folders_before(directory, "launches", kLaunchPrefix);
}

std::string frame_folder(uint64_t frame) {
  return fmt::format("{}{:04}", kFramePrefix, frame);
}

std::vector<std::string> frames_of(const std::string& directory) {
  return folders_before(directory, "frames", kFramePrefix);
}

RunDirectory::RunDirectory(std::string path) : path_(std::move(path)) {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error || !fs::is_directory(path_, error))
    throw UserError({path_}, "cannot create the output folder", "name another folder with --out");
}

void RunDirectory::check_ours() const {
  // The order matters: a run that begins at the same time writes its run.json before all other files.
  if (is_unused_folder(path_) || is_run_folder(path_)) return;
  throw UserError({path_}, "the folder holds files that are not of a run",
                  "give --out a new or empty folder, or that of an earlier run");
}

void RunDirectory::mark(RunInfo info) const {
  info.exit = int(Exit::Failure);
  info.message = kUnfinished;
  write_run(info);
}

void RunDirectory::begin(RunInfo info) {
  check_ours();
  lock_ = FolderLock(path_);
  const std::vector<std::string> earlier = own_files();
  std::error_code error;
  for (const std::string& name : info.saved)
    if (std::ranges::find(earlier, name) == earlier.end() &&
        fs::exists(fs::symlink_status(path_of(name), error)))
      throw UserError({path_of(name)},
                      "the file is not of an earlier run, and this run saves one of its name",
                      "move it away, or give --out a new or empty folder");
  // A killed run leaves this list, from which the next run knows what to remove.
  for (const std::string& name : saved_before(path_of("run.json")))
    if (std::ranges::find(info.saved, name) == info.saved.end()) info.saved.push_back(name);
  const std::vector<std::string> launches = launches_of(path_), frames = frames_of(path_);
  mark(info);
  remove_results();
  for (const auto* folders : {&launches, &frames})
    for (const std::string& name : *folders) remove_launch(name);
  remove_temporaries(path_, [&](const std::string& name) {
    return name == "run.json" || name == "config.toml" || std::ranges::find(earlier, name) != earlier.end();
  });
}

// Removes the directory of a launch or of a frame, unless it holds files of others.
void RunDirectory::remove_launch(const std::string& name) const {
  std::error_code error;
  if (!fs::is_directory(fs::symlink_status(path_of(name), error))) return;
  const RunDirectory launch(path_of(name));
  launch.remove_results();
  launch.remove("config.toml");
  launch.remove("run.json");
  fs::remove(launch.path(), error);
}

void RunDirectory::remove(const std::string& name) const {
  std::error_code error;
  if (fs::is_directory(fs::symlink_status(path_of(name), error)))
    throw UserError({path_of(name)}, "a folder stands where a run has a file",
                    "move it away, or name another folder with --out");
  written_.erase(name);
  fs::remove(path_of(name), error);
  if (error) throw UserError({path_of(name)}, "cannot remove what an earlier run left: " + error.message());
}

void RunDirectory::write(const std::string& name, const std::string& bytes) const {
  if (name.find('/') != std::string::npos) {
    std::error_code error;
    fs::create_directories(fs::path(path_of(name)).parent_path(), error);
    if (error) throw UserError({path_of(name)}, "cannot create its folder: " + error.message());
  }
  write_file(path_of(name), bytes);
  written_[name] = sum_of(bytes);
}

std::vector<std::string> RunDirectory::own_files() const {
  std::vector<std::string> names = saved_before(path_of("run.json"));
  for (const std::string& format : Registry<StatWriter>::names()) names.push_back("stats." + format);
  names.insert(names.end(), std::begin(kResults), std::end(kResults));
  return names;
}

void RunDirectory::remove_results() const {
  for (const std::string& name : own_files()) remove(name);
  const std::string folder = path_of(kFolder), index = std::string(kFolder) + "/maps.json";
  std::error_code error;
  if (!fs::is_directory(fs::symlink_status(folder, error))) return;
  remove_temporaries(folder, [](const fs::path& name) {
    return name == "maps.json" || name.extension() == ".npy" || name.extension() == ".png";
  });
  for (const std::string& map : maps_before(path_of(index)))
    for (const char* ending : {".npy", ".png"}) remove(std::string(kFolder) + "/" + map + ending);
  remove(index);
  fs::remove(folder, error);  // The folder stays when it holds files of others.
}

void RunDirectory::write_image(const pictures::ImageView& image, uint32_t threads) const {
  write("image.png", pictures::png_bytes(image, threads));
  write("image.pfm", pictures::pfm_bytes(image, threads));
}

void RunDirectory::write_stats(const stats::Group& root, bool compact) const {
  if (compact) {
    std::string out = "path,value,unit,doc\n";
    for (const StatRow& row : stat_totals(root))
      out += fmt::format("{},{},{},\n", csv_field(row.path), row.value, csv_field(row.unit));
    return write("stats.csv", out);
  }
  for (const std::string& format : Registry<StatWriter>::names())
    write("stats." + format, Registry<StatWriter>::instance().entry(format).make_default({})->write(root));
}

void RunDirectory::write_config(const std::vector<ParamInfo>& params, const std::string& title,
                                bool compact) const {
  write("config.toml", config_file(params, title, !compact));
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
  if (!info.scene_file.empty()) json["scene"]["file"] = info.scene_file;
  json["shader"] = info.shader;
  json["config"] = {{"name", info.config}, {"hash", fmt::format("{:016x}", info.config_hash)}};
  for (const auto& [name, value] : info.memory_peaks) json["memory_peaks"][name] = value;
  json["mode"] = info.mode;
  for (const auto& [key, value] : info.frame) json[pointer_of(key)] = value;
  for (const auto& [key, value] : info.overrides) json["overrides"][key] = value;
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
  if (info.compact) json["statistics"] = "compact";
  if (!info.faults.empty()) json["faults"] = nlohmann::ordered_json::array();
  for (const FaultInfo& fault : info.faults)
    json["faults"].push_back({{"kind", fault.kind},
                              {"place", fault.place},
                              {"what", fault.what},
                              {"launch_id", fault.launch_id},
                              {"count", fault.count}});
  for (const auto& [file, found] : info.not_finite) {
    json["not_finite"][file] = {{"pixels", found.pixels}, {"x", found.x}, {"y", found.y}};
    if (!found.stored_at.empty()) json["not_finite"][file]["stored_at"] = found.stored_at;
  }
  if (!info.launches.empty()) json["launches"] = info.launches;
  add_frames(info, json);
  if (!info.saved.empty()) json["saved"] = info.saved;
  add_outputs(info, json);
  written_.erase("run.json");  // A file cannot hold its own sum.
  json["files"] = json_of(written_);
  if (info.part) json["partial"] = json_of(*info.part);
  if (info.sample) json["sample"] = json_of(*info.sample);
  json["exit"] = info.exit;
  if (!info.message.empty()) json["message"] = info.message;
  using ErrorHandler = nlohmann::ordered_json::error_handler_t;
  write("run.json", json.dump(2, ' ', false, ErrorHandler::replace) + "\n");  // argv may be other than UTF-8
}

}  // namespace glint::report
