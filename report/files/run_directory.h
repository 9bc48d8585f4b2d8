// Writes the folder that a run leaves behind: complete and self-describing, each file whole or not at all.
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
#include "pictures/encode.h"
#include "report/files/file_list.h"
#include "report/files/folder_lock.h"
#include "report/picture/not_finite.h"

namespace glint::report {

// Describes a mistake of the shaders that `--on-fault warn` let pass.
struct FaultInfo {
  std::string kind, place, what;
  std::array<uint32_t, 3> launch_id{};  // launch id of the first fault
  uint64_t count = 0;
};

// Holds sizes of the acceleration structures of a scene.
struct StructureInfo {
  uint64_t bytes = 0, triangles = 0, procedurals = 0, bottom_levels = 0, instances = 0;
  uint32_t top_depth = 0, bottom_depth = 0;
};

// Says how much of a launch fits a core at a time, and what is used up first.
struct ResidencyInfo {
  uint32_t warps = 0, blocks = 0;
  std::string limit;
};

// Says that a launch was ended early, and how far it came. Its results are those up to there.
struct PartInfo {
  std::string reason;  // "max_cycles", "SIGINT", "SIGTERM"
  uint64_t cycles = 0, ended_warps = 0, num_warps = 0;
  std::string where;  // the line and loops where most running warps were; empty when none ran
};

// Says that only a sample of a launch's blocks, or of a run's launches, was timed (docs/sampling.md).
struct SampleInfo {
  enum class Of : uint8_t { Blocks, Launches };
  double share = 0;  // of the blocks that were timed, as it was asked for, or of the launches
  uint64_t seed = 0;
  Of of = Of::Blocks;
  uint64_t all = 0, timed = 0;  // blocks of the launch, or launches of the run
  uint32_t scale = 1;           // 1/scale of the machine ran the blocks
  uint64_t warm = 0;            // blocks that ran functionally
  std::string by{};             // how blocks were chosen, as --sample-by names it
  uint64_t clusters = 0;        // of launches
};

// Names a file that holds an image or a buffer of a pipeline, or a buffer of a kernel. It is incomplete when
// only a sample of the launch's blocks ran.
struct OutputInfo {
  std::string file, name;
  bool is_image = false;
};

// Says which frames of a scene that moves were rendered, and how.
struct SequenceInfo {
  uint64_t first = 0, last = 0;
  double fps = 24;
  std::string structures, caches;      // as the options --structures and --caches name them
  std::string camera_path, animation;  // empty: none, and the file's first one
  double seconds_of(uint64_t frame) const { return double(frame) / fps; }
};

// Says which frame of a sequence a run is.
struct MomentInfo {
  uint64_t frame = 0;
  double seconds = 0;  // from the beginning of the motion
};

inline constexpr int kRunSchema = 1;  // schema of run.json

// Holds what run.json says besides schema and paths. Only this file of a run holds wall-clock times.
struct RunInfo {
  std::vector<std::string> command;  // argv
  std::string version, git, compiler;
  std::vector<std::pair<std::string, std::string>> plugins;  // their files and the hashes of their contents
  std::string scene, scene_form, scene_note, shader, config, mode;
  // The path of the file that says what is launched (a scene, a pipeline, kernels), as the command line has
  // it; empty for what has no such file.
  std::string scene_file;
  uint64_t scene_hash = 0, scene_triangles = 0, config_hash = 0;
  double scene_fraction = 1;  // fraction of the original's triangles
  // These are the parameters of the frame, in the order of the file. A dot in a key leads into a table. A
  // launch without a frame has only these four.
  std::vector<std::pair<std::string, uint64_t>> frame = {
      {"width", 0}, {"height", 0}, {"samples", 0}, {"seed", 0}};
  std::vector<std::pair<std::string, std::string>> overrides;  // what the command line changed of the scene
  std::optional<StructureInfo> structures;                     // set once they are built
  std::optional<ResidencyInfo> residency;                      // set for a timing run
  std::vector<std::pair<std::string, double>> memory_peaks;    // the best that the memory system could do
  std::string started;                                         // ISO 8601, UTC
  double wall_seconds = 0;
  std::string on_fault = "stop";
  std::vector<FaultInfo> faults;
  std::vector<std::pair<std::string, NotFinite>> not_finite;  // pictures with pixels that are not finite
  std::vector<std::string> saved;        // files that a pipeline or a kernel was asked to keep
  std::vector<OutputInfo> outputs;       // what these files hold
  std::vector<std::string> launches;     // folders of a list of launches, in order; each is a run directory
  std::vector<std::string> frames;       // folders of frames, in order; each is a run directory
  std::optional<SequenceInfo> sequence;  // of a run of frames, and of each of them
  std::optional<MomentInfo> moment;      // of a frame
  bool compact = false;                  // The statistics are totals over units (stat_totals()).
  std::optional<PartInfo> part;
  std::optional<SampleInfo> sample;
  int exit = 0;
  std::string message;  // why exit is not 0
};

// Returns the name of the folder of launch `number` of a list: "launch-0-trace".
std::string launch_folder(size_t number, const std::string& name);
// Returns the folders of the launches that a run's run.json lists, in order; none when it is of one launch.
std::vector<std::string> launches_of(const std::string& directory);

// Do the same for frames: "frame-0007".
std::string frame_folder(uint64_t frame);
std::vector<std::string> frames_of(const std::string& directory);

// Writes a file under another name and renames it, so that a reader never sees half a file. When the file
// cannot be written, nothing stays behind, and UserError is thrown. Anything but a regular file (a pipe, a
// device) is written to directly.
void write_file(const std::string& path, const std::string& bytes);

// Writes the files of a run through write_file(). A run.json that says that the run has not ended is written
// first, and the real one last. A directory whose run.json has exit 0 is therefore complete. run.json lists
// every file that this object has written, with what it held. Throws UserError when the folder or a file
// cannot be written.
class RunDirectory {
 public:
  explicit RunDirectory(std::string path);  // the folder is made with its parents
  const std::string& path() const { return path_; }
  std::string path_of(const std::string& name) const { return path_ + "/" + name; }

  // Writes a file. "heat/rays.png" is in a folder below.
  void write(const std::string& name, const std::string& bytes) const;
  // Throws UserError unless the folder is empty or an earlier run has marked it with a run.json.
  void check_ours() const;
  void mark(RunInfo info) const;  // writes the run.json of a run that has not ended
  // Begins a run: checks the folder, locks it until this object dies, marks it, and removes the results of an
  // earlier run. `info.saved` has the files that this run is going to save. Throws UserError, before anything
  // is touched, when another process writes into the folder or such a file is not of an earlier run.
  void begin(RunInfo info);
  void remove(const std::string& name) const;  // removes a file of an earlier run, if it exists
  // Removes the results that this run or an earlier one has left. config.toml, run.json and files of others
  // stay.
  void remove_results() const;
  // Writes image.png and image.pfm, which up to `threads` threads of the host encode.
  void write_image(const pictures::ImageView& image, uint32_t threads) const;
  // Writes stats.<format> of every registered format, or, for RunInfo::compact, stats.csv with totals alone.
  void write_stats(const stats::Group& root, bool compact = false) const;
  // Writes config.toml, without comments for RunInfo::compact.
  void write_config(const std::vector<ParamInfo>& params, const std::string& title,
                    bool compact = false) const;
  void write_run(const RunInfo& info) const;            // run.json
  const FileList& written() const { return written_; }  // what this object has written and not removed

 private:
  void remove_launch(const std::string& name) const;
  std::vector<std::string> own_files() const;  // results that a run may have left beside the folder heat

  std::string path_;
  FolderLock lock_;
  mutable FileList written_;  // It says what is in the folder, which const functions change, too.
};

}  // namespace glint::report
