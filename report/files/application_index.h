// Describes what an application did on a device of the Vulkan driver: its index.json.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace glint::report {

inline constexpr int kApplicationSchema = 2;                    // schema of index.json
inline constexpr const char* kApplicationIndex = "index.json";  // its name in the application's folder

// Is one launch, one build of an acceleration structure, one presented frame, or all transfers between two of
// these.
struct DeviceCommand {
  std::string kind;     // "dispatch", "trace"; "build"; "present"; "transfer"
  uint64_t number = 0;  // of a launch, counted from 0 over all kinds of launches
  uint64_t frame = 0;   // how many frames were presented before; of a present: its number
  std::string shader, label;
  std::array<uint64_t, 3> size{};  // blocks of a dispatch, rays of a trace, pixels of a present
  uint64_t begin = 0, end = 0;     // core cycles on the device's clock
  uint64_t instructions = 0;       // warp instructions
  std::optional<uint64_t> cycles;  // of a launch that the timing machine ran
  uint64_t faults = 0;             // that were let pass
  uint64_t count = 1, bytes = 0;   // of transfers; of a build: primitives, and the structure's bytes
  std::string structure;           // the name of what a build has made
  bool is_top = false, is_update = false, on_host = false;  // of a build
  std::string folder;                                       // the run directory of a timed launch
  uint64_t dropped = 0;  // draws of a present's frame that are not in its picture
  std::string file;      // the picture of a present that has one of its own
  std::string error;     // why the launch did not end
};

// Is what the driver did not do, and how often.
struct NotDone {
  std::string what, why;
  uint64_t count = 1;
};

struct ApplicationFacts {
  std::string program;
  std::vector<std::string> command;  // argv
  std::string version, git, config, timing, started;
  uint64_t process = 0;
  double clock_mhz = 0;
  bool has_ended = false;        // The device was destroyed, or the application ended.
  std::vector<NotDone> dropped;  // commands that are not there
  std::vector<NotDone> refused;  // calls that failed
};

// Builds the text of an index.json of many commands without building those again that it had before.
class ApplicationIndex {
 public:
  void add(const DeviceCommand& command);
  size_t size() const { return size_; }
  std::string text(const ApplicationFacts& facts) const;

 private:
  size_t size_ = 0;
  std::string commands_;  // a line for each
};

// Returns the index of an application's folder. Throws UserError when there is none, or when the file is not
// what this version writes.
nlohmann::ordered_json read_application(const std::string& folder);
// Returns whether a command of an index is a launch.
bool is_launch(const nlohmann::ordered_json& command);
// Returns whether a folder holds an index.
bool is_application_folder(const std::string& folder);

}  // namespace glint::report
