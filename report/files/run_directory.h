// The folder that a run leaves behind: complete, self-describing, each file written whole or not at all.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/params.h"
#include "base/stats.h"
#include "report/picture/image_files.h"

namespace glint::report {

// A mistake of the shaders that `--on-fault warn` let pass.
struct FaultInfo {
  std::string kind, place, what;
  std::array<uint32_t, 3> launch_id{};  // of the first
  uint64_t count = 0;
};

// What the acceleration structures of a scene came to.
struct StructureInfo {
  uint64_t bytes = 0, triangles = 0, procedurals = 0, bottom_levels = 0, instances = 0;
  uint32_t top_depth = 0, bottom_depth = 0;
};

// What of a launch fits a core at a time, and what is used up first.
struct ResidencyInfo {
  uint32_t warps = 0, blocks = 0;
  std::string limit;
};

inline constexpr int kRunSchema = 1;  // of run.json

// What run.json says besides schema and paths. The only file of a run that holds wall-clock times.
struct RunInfo {
  std::vector<std::string> command;  // argv
  std::string version, git, compiler;
  std::string scene, scene_form, scene_note, shader, config, mode;
  uint64_t scene_hash = 0, scene_triangles = 0, config_hash = 0;
  double scene_fraction = 1;  // of the original's triangles
  // The parameters of the frame, in the order of the file; a dot in a key leads into a table. A launch
  // without a frame has only these.
  std::vector<std::pair<std::string, uint64_t>> frame = {
      {"width", 0}, {"height", 0}, {"samples", 0}, {"seed", 0}};
  std::optional<StructureInfo> structures;                   // once they are built
  std::optional<ResidencyInfo> residency;                    // of a timing run
  std::vector<std::pair<std::string, double>> memory_peaks;  // what the memory system could do at best
  std::string started;                                       // ISO 8601, UTC
  double wall_seconds = 0;
  std::string on_fault = "stop";
  std::vector<FaultInfo> faults;
  std::vector<std::string> saved;  // files that a pipeline or a kernel was asked to keep
  int exit = 0;
  std::string message;  // of the error, when exit is not 0
};

// Writes a file under another name and renames it: a reader never sees half a file, and nothing stays behind
// when it cannot be written, which is a UserError. What is no regular file (a pipe, a device) is written to
// as it is.
void write_file(const std::string& path, const std::string& bytes);

// Files go through write_file(); run.json is written last: a directory with one is complete, or says what
// went wrong. UserError when the folder or a file cannot be written.
class RunDirectory {
 public:
  explicit RunDirectory(std::string path);  // made with its parents
  const std::string& path() const { return path_; }
  std::string path_of(const std::string& name) const { return path_ + "/" + name; }

  void write(const std::string& name,
             const std::string& bytes) const;  // "heat/rays.png": in a folder below it
  void remove(const std::string& name) const;  // a file or folder that an earlier run left, if it is there
  // All that an earlier run left but config.toml, run.json first; and `saved`. Files of other commands stay.
  void remove_results(const std::vector<std::string>& saved) const;
  void write_image(const ImageView& image) const;    // image.png, image.pfm
  void write_stats(const stats::Group& root) const;  // stats.<format> of every registered format
  void write_config(const std::vector<ParamInfo>& params, const std::string& title) const;  // config.toml
  void write_run(const RunInfo& info) const;                                                // run.json

 private:
  std::string path_;
};

}  // namespace glint::report
