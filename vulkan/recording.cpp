// Leaves what an application did on a device: a run directory of each timed launch, and the index above them.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/recording.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <fmt/format.h>
#include <set>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "base/diagnostics.h"
#include "report/files/run_directory.h"
#include "report/picture/image_compare.h"
#include "setup/capsule_file.h"
#include "setup/observation_files.h"
#include "setup/recorded_launch.h"
#include "vulkan/guard.h"
#include "vulkan/process.h"

namespace glint::vulkan {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMostRefusals = 32;  // Beyond these, only those are counted that were there before.
// The index is written again when so large a part of it is new. So an application with many launches does
// not spend its time on writing them, and a killed one loses few.
constexpr size_t kNewPart = 64;
constexpr int kMostFolders = 1000;
constexpr std::chrono::milliseconds kBetweenTold{250};
// The picture of the last frame is written again after this time, so that a killed application leaves one.
constexpr std::chrono::seconds kBetweenPictures{1};

// Holds the recordings that have not ended. Applications may end without destroying their devices, and the
// system then unloads the driver.
class OpenRecordings {
 public:
  ~OpenRecordings() {
    for (Recording* each : all_) each->finish();
  }
  void add(Recording* recording) {
    const std::lock_guard lock(mutex_);
    all_.insert(recording);
  }
  void remove(Recording* recording) {
    const std::lock_guard lock(mutex_);
    all_.erase(recording);
  }
  static OpenRecordings& instance() {
    static OpenRecordings all;
    return all;
  }

 private:
  std::mutex mutex_;
  std::set<Recording*> all_;
};

// Makes a folder, or takes one that is empty, and writes the index there. Returns false when somebody else
// has the folder. Throws UserError when it cannot be written.
bool claim(const std::string& folder, const std::string& index) {
  std::error_code error;
  if (const fs::path parent = fs::path(folder).parent_path(); !parent.empty())
    fs::create_directories(parent, error);
  const bool is_new = fs::create_directory(folder, error);
  if (!is_new && (error || !fs::is_empty(folder, error) || error)) {
    if (fs::exists(folder, error)) return false;
    throw UserError({folder}, "cannot create the folder", "name another one with GLINT_OUT");
  }
  // Another process may take the folder just now, empty as it is. Only one of them can make the link.
  const std::string path = folder + "/" + report::kApplicationIndex,
                    temporary = fmt::format("{}.{}.tmp", path, ::getpid());
  report::write_file(temporary, index);
  fs::create_hard_link(temporary, path, error);
  if (error && is_new && error != std::errc::file_exists) {  // a file system without links
    fs::rename(temporary, path, error);
    return !error;
  }
  const bool is_ours = !error;
  fs::remove(temporary, error);
  return is_ours;
}

}  // namespace

Recording::Recording(const Settings& settings, const pipeline::GpuParams& machine, const Messages& messages,
                     DeviceClock& clock)
    : settings_(settings),
      machine_(machine),
      messages_(messages),
      clock_(clock),
      is_on_(!settings.out.empty() || !settings.timing.is_empty() || settings.asks_for_pictures ||
             !settings.save.is_empty()) {
  if (!is_on_) return;
  const report::RunInfo info = setup::new_run_info(machine, settings.preset, "timing");
  facts_.command = command_of_process();
  facts_.program = program_of_process();
  facts_.version = info.version, facts_.git = info.git, facts_.started = info.started;
  facts_.config = settings.preset, facts_.timing = settings.timing_text;
  facts_.process = uint64_t(::getpid());
  facts_.clock_mhz = machine.clock_mhz;
  OpenRecordings::instance().add(this);
}

Recording::~Recording() {
  if (is_on_) finish();
  OpenRecordings::instance().remove(this);
}

void Recording::fail(const std::string& why) {
  is_on_ = false;
  messages_.error("nothing more is recorded of the launches: " + why);
}

bool Recording::begin() {
  if (!is_on_ || !folder_.empty()) return is_on_;
  try {
    for (int i = 1; i <= kMostFolders; ++i) {
      const std::string first = settings_.out.empty() ? "out/vulkan-" + facts_.program : settings_.out;
      const std::string folder =
          i == 1 ? first : fmt::format("{}{}{}", first, settings_.out.empty() ? '-' : '.', i);
      if (!claim(folder, index_.text(facts_))) continue;
      folder_ = folder;
      return true;
    }
    fail("a thousand folders for it are there already");
  } catch (const Error& error) {
    fail(error.what());
  }
  return false;
}

void Recording::write_index(bool at_once) {
  if (!is_on_ || folder_.empty()) return;
  if (!at_once && (index_.size() - written_) * kNewPart < index_.size()) return;
  facts_.dropped = dropped_;
  for (const std::string& each : commands_not_there())
    facts_.dropped.push_back({each, "the command is not there", 1});
  try {
    report::write_file(folder_ + "/" + report::kApplicationIndex, index_.text(facts_));
    written_ = index_.size();
  } catch (const Error& error) {
    fail(error.what());
  }
}

void Recording::add_transfers() {
  const DeviceClock::Transfers all = clock_.take_transfers();
  if (all.count == 0) return;
  report::DeviceCommand command;
  command.kind = "transfer", command.begin = all.begin, command.end = all.end;
  command.count = all.count, command.bytes = all.bytes;
  index_.add(command);
}

void Recording::add(report::DeviceCommand command) {
  const std::lock_guard lock(mutex_);
  if (!begin()) return;
  add_transfers();
  index_.add(command);
  write_index(command.cycles.has_value() || !command.error.empty());
}

void Recording::write_pictures(const std::string& name, const std::vector<ShownImage>& images) {
  for (size_t i = 0; i < images.size() && is_on_; ++i) {
    report::Picture picture{images[i].width, images[i].height, {}};
    picture.rgb.reserve(images[i].rgb.size());
    for (const uint8_t each : images[i].rgb) picture.rgb.push_back(float(each) / 255.0f);
    const std::string number = i == 0 ? "" : fmt::format("-{}", i + 1);
    try {
      report::write_file(fmt::format("{}/{}{}.png", folder_, name, number), report::png_of(picture));
    } catch (const Error& error) {
      return fail(error.what());
    }
  }
}

void Recording::write_last_frame() {
  write_pictures("present-last", std::exchange(last_frame_, {}));
}

void Recording::add_frame(uint64_t number, VkExtent2D size, std::vector<ShownImage> images) {
  const std::lock_guard lock(mutex_);
  if (!begin()) return;
  add_transfers();
  report::DeviceCommand command;
  command.kind = "present", command.frame = number, command.size = {size.width, size.height, 1};
  command.begin = command.end = clock_.now();
  command.dropped = std::exchange(dropped_in_frame_, 0);
  if (settings_.pictures.keeps_last()) {
    last_frame_ = std::move(images);
    if (const auto now = std::chrono::steady_clock::now(); now >= next_picture_) {
      write_last_frame();
      next_picture_ = std::chrono::steady_clock::now() + kBetweenPictures;
    }
  } else if (!images.empty()) {
    const std::string name = fmt::format("present-{:04}", number);
    write_pictures(name, images);
    command.file = name + ".png";
  }
  index_.add(command);
  write_index(false);
}

void Recording::add_refusal(const std::string& command, const std::string& why) {
  const std::lock_guard lock(mutex_);
  if (!is_on_) return;
  auto& all = facts_.refused;
  const auto same = std::find_if(all.begin(), all.end(), [&](const report::NotDone& each) {
    return each.what == command && each.why == why;
  });
  if (same != all.end())
    ++same->count;
  else if (all.size() < kMostRefusals)
    all.push_back({command, why, 1});
}

void Recording::add_capsule(const pipeline::Capsule& capsule) {
  const std::lock_guard lock(mutex_);
  if (!begin()) return;
  const std::string path =
      fmt::format("{}/launch-{}-{}{}", folder_, capsule.number, capsule.kind, setup::kCapsuleEnding);
  try {
    report::write_file(path, setup::capsule_bytes(capsule));
    messages_.info(fmt::format("{} {} is saved: glint run {}", capsule.kind, capsule.number, path));
  } catch (const Error& error) {
    fail(error.what());
  }
}

bool Recording::add_dropped(const std::string& what, const std::string& why) {
  const std::lock_guard lock(mutex_);
  const auto same = std::find_if(dropped_.begin(), dropped_.end(),
                                 [&](const report::NotDone& each) { return each.what == what; });
  ++dropped_in_frame_;
  if (same != dropped_.end()) {
    ++same->count;
    return false;
  }
  dropped_.push_back({what, why, 1});
  return true;
}

void Recording::finish() {
  const std::lock_guard lock(mutex_);
  add_transfers();
  if (!last_frame_.empty()) write_last_frame();
  facts_.has_ended = true;
  write_index(true);
}

void Recording::tell_progress(const report::DeviceCommand& command,
                              const pipeline::LaunchProgress& progress) {
  const auto now = std::chrono::steady_clock::now();
  if (!settings_.tells_progress || folder_.empty() || now < next_told_) return;
  next_told_ = now + kBetweenTold;
  try {
    report::write_file(folder_ + "/progress",
                       fmt::format("{} {} {} {} {}\n", command.number, progress.ended_warps,
                                   progress.num_warps, progress.cycles, command.shader));
  } catch (const Error&) {  // The index will say so, when it cannot be written either.
  }
}

void Recording::run(report::DeviceCommand& command, const Timed& timed) {
  bool is_recorded = false;
  {
    const std::lock_guard lock(mutex_);
    is_recorded = begin();
  }
  if (!is_recorded) {
    const pipeline::RenderResult result = timed.launch();
    timed.take_prints();
    return timed.ended(result);
  }
  const std::string name = report::launch_folder(command.number, command.kind),
                    temporary = fmt::format("{}/.{}.tmp", folder_, name);
  const auto keep = [&] {
    std::error_code error;
    fs::rename(temporary, folder_ + "/" + name, error);
    command.folder = error ? "" : name;
    add(command);
  };
  try {
    run_in(temporary, command, timed);
  } catch (const std::exception& error) {
    command.error = error.what();
    keep();
    throw;
  }
  keep();
}

void Recording::run_in(const std::string& folder, report::DeviceCommand& command, const Timed& timed) {
  bool has_begun = false, has_ended = false;
  try {
    report::RunDirectory directory(folder);
    report::RunInfo info = setup::new_run_info(machine_, settings_.preset, "timing");
    info.command = facts_.command;
    info.scene = fmt::format("{} {} {}", facts_.program, command.kind, command.number);
    info.scene_form = "application", info.scene_note = command.label;
    info.scene_hash = timed.hash;
    info.shader = command.shader, info.compact = settings_.is_compact;
    info.frame[0].second = timed.threads[0], info.frame[1].second = timed.threads[1];
    info.on_fault = exec::name_of(settings_.on_fault);
    setup::begin_directory(directory, info, machine_,
                           fmt::format("{}: {}  {} x {} x {} threads, timing on {}", info.scene, info.shader,
                                       timed.threads[0], timed.threads[1], timed.threads[2], info.config));
    has_begun = true;
    setup::record_launch(directory, info,
                         {.launch = timed.launch,
                          .keep =
                              [&](const pipeline::RenderResult& result) {
                                has_ended = true;
                                timed.ended(result);
                                directory.write_stats(result.statistics(), info.compact);
                                for (const std::string& warning :
                                     setup::write_observation(timed.observe, result, directory).warnings)
                                  messages_.warning(warning);
                              },
                          .take_prints = timed.take_prints});
  } catch (const UserError& error) {
    if (has_begun && !has_ended) throw;  // the launch's own
    {
      const std::lock_guard lock(mutex_);
      fail(error.what());
    }
    if (!has_ended) timed.ended(timed.launch());
  }
}

}  // namespace glint::vulkan
