// Leaves what an application did on a device: a run directory of each timed launch, and the index above them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "pipeline/capsule/capsule.h"
#include "pipeline/render.h"
#include "report/files/application_index.h"
#include "vulkan/clock.h"
#include "vulkan/messages.h"
#include "vulkan/settings.h"

namespace glint::vulkan {

// Is what a presented image shows: rows from the top, with three bytes a pixel.
struct ShownImage {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgb;
};

// The folder is made at the first launch. Nothing that is there is touched: where the name is taken, the
// folder gets a number. A file is whole or not there, and so is the directory of a launch, because both are
// renamed when they are ready. So an application may be killed at any time. A folder that cannot be written
// is said once, and the application goes on without.
class Recording {
 public:
  Recording(const Settings& settings, const pipeline::GpuParams& machine, const Messages& messages,
            DeviceClock& clock);
  ~Recording();  // writes the index for the last time
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  // Says how a launch is run that leaves a run directory.
  struct Timed {
    uint64_t hash = 0;                  // of what is launched
    pipeline::Observation observe;      // what to write of it
    std::array<uint32_t, 3> threads{};  // of the launch
    std::function<pipeline::RenderResult()> launch;
    std::function<void(const pipeline::RenderResult&)> ended;  // is called before anything is written
    std::function<std::string()> take_prints;
  };
  // Launches, writes the run directory, and adds the launch, which `ended` completes, to the index. Throws
  // what `launch` throws, after it was written.
  void run(report::DeviceCommand& command, const Timed& timed);
  // Adds a launch that leaves no run directory.
  void add(report::DeviceCommand command);
  // Adds a frame of `size` pixels that was presented, and writes its pictures as PNG: one for each image.
  void add_frame(uint64_t number, VkExtent2D size, std::vector<ShownImage> images);
  // Writes a launch that can run again alone.
  void add_capsule(const pipeline::Capsule& capsule);
  // Notes a call that failed. Any thread may call it.
  void add_refusal(const std::string& command, const std::string& why);
  // Counts what the device drops. Returns whether it is the first of its kind.
  bool add_dropped(const std::string& what, const std::string& why);
  // Tells a watching process how far the launch is that runs.
  void tell_progress(const report::DeviceCommand& command, const pipeline::LaunchProgress& progress);
  // Writes the index as that of an application that has ended.
  void finish();
  // Returns whether anything that happens is recorded.
  bool is_on() const { return is_on_; }
  // Returns the application's folder, or "" when there is none.
  std::string folder() const { return folder_; }

 private:
  bool begin();  // makes the folder unless it is there; false: nothing is recorded
  void add_transfers();
  void write_index(bool at_once);
  void fail(const std::string& why);  // ends the recording
  void write_last_frame();
  void write_pictures(const std::string& name, const std::vector<ShownImage>& images);
  void run_in(const std::string& folder, report::DeviceCommand& command, const Timed& timed);

  const Settings& settings_;
  const pipeline::GpuParams& machine_;
  const Messages& messages_;
  DeviceClock& clock_;
  mutable std::mutex mutex_;  // `facts_.refused`, which any thread may add to
  report::ApplicationFacts facts_;
  report::ApplicationIndex index_;
  std::vector<report::NotDone> dropped_;  // draws, by pipeline
  uint64_t dropped_in_frame_ = 0;         // draws since the last frame
  size_t written_ = 0;                    // commands in the file
  bool is_on_;
  std::string folder_;
  std::chrono::steady_clock::time_point next_told_{};
  std::vector<ShownImage> last_frame_;  // that has no picture yet; empty: it has one
  std::chrono::steady_clock::time_point next_picture_{};
};

}  // namespace glint::vulkan
