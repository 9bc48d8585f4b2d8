// Runs a Vulkan program on Glint's driver, and says at the end what it did there.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/vulkan_program.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <unistd.h>
#include <utility>

#include "apps/glint/options/config.h"
#include "apps/glint/options/report_writer.h"
#include "apps/glint/run/child_process.h"
#include "report/files/application_index.h"
#include "report/terminal/progress.h"
#include "setup/launch_selection.h"
#include "setup/resources.h"

namespace glint::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Variables = std::vector<std::pair<std::string, std::string>>;

constexpr size_t kMostLines = 10;  // of launches, and of what was refused
constexpr int kMostFolders = 1000;

// Returns the manifest of the driver that belongs to this command: beside an installed one, or in the build
// folder.
std::string manifest() {
  std::error_code error;
  const fs::path command = fs::read_symlink("/proc/self/exe", error);
  for (fs::path folder = command.parent_path(); folder.has_relative_path(); folder = folder.parent_path())
    for (const fs::path& each : {folder / "share/vulkan/icd.d/glint_icd.json", folder / "glint_icd.json"})
      if (fs::is_regular_file(each, error)) return each.string();
  throw UserError({}, "this Glint was built without its Vulkan driver",
                  "install libvulkan-dev and build it again");
}

// Returns a folder that is not there yet, or an empty one that the user names.
std::string new_folder(const VulkanProgram& program) {
  std::error_code error;
  if (!program.out.empty()) {
    if (fs::exists(program.out, error) &&
        !(fs::is_directory(program.out, error) && fs::is_empty(program.out, error)))
      throw UserError({program.out}, "the folder is not empty", "give --out a new or empty folder");
    return program.out;
  }
  const std::string name = "out/vulkan-" + fs::path(program.command[0]).filename().string();
  for (int i = 1; i <= kMostFolders; ++i)
    if (const std::string out = i == 1 ? name : fmt::format("{}-{}", name, i); !fs::exists(out, error))
      return out;
  throw UserError({name}, "a thousand folders for this program are there already",
                  "name another one with --out");
}

Variables variables_of(const VulkanProgram& program, const std::string& folder) {
  std::string observe;
  if (program.profile) observe += "profile ";
  if (program.heat) observe += "heat ";
  if (program.trace) observe += "trace ";
  if (program.sample) observe += fmt::format("sample={}", program.sample);
  const std::string driver = manifest();
  return {{"VK_DRIVER_FILES", driver},
          {"VK_ICD_FILENAMES", driver},  // the same for loaders before 1.3.207
          {"GLINT_TIMING", program.timing},
          {"GLINT_VK_SAVE", program.save},
          {"GLINT_CONFIG", program.config},
          {"GLINT_SET", fmt::format("{}", fmt::join(program.settings, " "))},
          {"GLINT_OUT", fs::absolute(folder).lexically_normal().string()},
          {"GLINT_OBSERVE", observe},
          {"GLINT_STATS", program.stats},
          {"GLINT_THREADS", std::to_string(program.threads)},
          {"GLINT_ON_FAULT", program.on_fault},
          {"GLINT_VK_QUEUE", program.queue},
          {"GLINT_VK_PRESENT", program.present},
          {"GLINT_PROGRESS", ::isatty(STDERR_FILENO) ? "1" : ""}};
}

// Draws how far the timed launch is that runs.
class Watching {
 public:
  Watching(const Session& session, const std::string& folder) : session_(session), folder_(folder) {}
  void look() {
    if (!::isatty(STDERR_FILENO)) return;
    std::istringstream text(setup::text_of_file(folder_ + "/progress").value_or(""));
    uint64_t number = 0, ended = 0, all = 0, cycles = 0;
    std::string shader;
    if (!(text >> number >> ended >> all >> cycles) || !std::getline(text >> std::ws, shader)) return;
    if (!progress_ || number != number_) {
      number_ = number;
      progress_.emplace(stderr, fmt::format("launch {}: {}", number, shader), session_.terminal);
    }
    progress_->update(ended, all, {cycles, 0});
  }
  void end() {
    progress_.reset();
    std::error_code ignored;
    fs::remove(folder_ + "/progress", ignored);
  }

 private:
  const Session& session_;
  const std::string& folder_;
  uint64_t number_ = 0;
  std::optional<report::Progress> progress_;
};

// Returns what ran on one device, by kind: "3 dispatches, 2 transfers of 4096 bytes".
std::string kinds_of(const Json& index) {
  uint64_t dispatches = 0, traces = 0, transfers = 0, bytes = 0, builds = 0;
  for (const Json& each : index["commands"]) {
    const std::string kind = each["kind"];
    dispatches += kind == "dispatch", traces += kind == "trace", builds += kind == "build";
    if (kind == "transfer")
      transfers += each["count"].get<uint64_t>(), bytes += each["bytes"].get<uint64_t>();
  }
  std::vector<std::string> out;
  if (dispatches) out.push_back(fmt::format("{} dispatches", dispatches));
  if (traces) out.push_back(fmt::format("{} traces", traces));
  if (transfers) out.push_back(fmt::format("{} transfers of {} bytes", transfers, bytes));
  if (builds) out.push_back(fmt::format("{} builds of acceleration structures", builds));
  return out.empty() ? "nothing" : fmt::format("{}", fmt::join(out, ", "));
}

// Returns what ran on one device, line by line.
std::string account_of(const Json& index, const std::string& folder) {
  std::vector<const Json*> timed;
  size_t launches = 0, failed = 0, frames = 0;
  uint64_t cycles = 0;
  for (const Json& each : index["commands"]) {
    frames += each["kind"] == "present";
    if (!report::is_launch(each)) continue;
    ++launches, failed += each.contains("error");
    if (each["cycles"].is_null()) continue;
    timed.push_back(&each), cycles += each["cycles"].get<uint64_t>();
  }
  std::string out = fmt::format("{} of {} launches were timed: {} cycles\n  ran: {}\n", timed.size(),
                                launches, cycles, kinds_of(index));
  if (frames) out += fmt::format("  {} frames were presented\n", frames);
  std::stable_sort(timed.begin(), timed.end(), [](const Json* a, const Json* b) {
    return (*a)["cycles"].get<uint64_t>() > (*b)["cycles"].get<uint64_t>();
  });
  for (size_t i = 0; i < std::min(timed.size(), kMostLines); ++i)
    out += fmt::format("  {:>12} cycles  {} {}: {}, {}/{}\n", (*timed[i])["cycles"].get<uint64_t>(),
                       (*timed[i])["kind"].get<std::string>(), (*timed[i])["number"].get<uint64_t>(),
                       (*timed[i])["shader"].get<std::string>(), folder, timed[i]->value("folder", ""));
  if (timed.size() > kMostLines) out += fmt::format("  and {} more\n", timed.size() - kMostLines);
  for (const Json& each : index["commands"])
    if (each.contains("error"))
      out += fmt::format("failed: {} {}: {}\n", each["kind"].get<std::string>(),
                         each["number"].get<uint64_t>(), each["error"].get<std::string>());
  for (const Json& each : index["dropped"])
    out += fmt::format("dropped: {}, {} times ({})\n", each["what"].get<std::string>(),
                       each["count"].get<uint64_t>(), each["why"].get<std::string>());
  for (size_t i = 0; i < std::min(index["refused"].size(), kMostLines); ++i)
    out += fmt::format("refused: {}: {}\n", index["refused"][i]["what"].get<std::string>(),
                       index["refused"][i]["why"].get<std::string>());
  if (launches && timed.empty() && !failed)
    out += "note: --timing chooses launches to time: 'first 1' takes the first one of each pipeline\n";
  return out;
}

// Says what ran, and writes the report. The program's exit code counts whatever happens here.
void tell(const Session& session, const VulkanProgram& program, const std::string& first) {
  std::vector<std::string> folders;
  for (int i = 1; i <= kMostFolders; ++i) {
    const std::string folder = i == 1 ? first : fmt::format("{}.{}", first, i);
    if (!report::is_application_folder(folder)) break;
    folders.push_back(folder);
  }
  if (folders.empty()) return fmt::print(stderr, "glint: no launch ran on Glint's device\n");
  for (const std::string& folder : folders) {
    try {
      fmt::print(stderr, "glint: {}", account_of(report::read_application(folder), folder));
      if (!program.no_report) fmt::print(stderr, "report: {}\n", make_report(session, {folder}, "", {}));
    } catch (const Error& error) {
      fmt::print(stderr, "{}\n", error.what());
    }
  }
}

}  // namespace

Exit run_vulkan_program(const Session& session, const VulkanProgram& program) {
  for (const std::string& setting : program.settings)
    if (setting.find(' ') != std::string::npos)
      throw UserError({}, fmt::format("--set '{}' has a space in it, which the driver cannot take", setting));
  read_config(session.resources, program.config, program.settings);
  setup::LaunchSelection::parse(program.timing, "--timing");  // for its errors: the driver reads it again
  const std::string folder = new_folder(program);
  Watching watching(session, folder);
  const int code = run_child(program.command, variables_of(program, folder), [&] { watching.look(); });
  watching.end();
  tell(session, program, folder);
  return Exit(code);
}

}  // namespace glint::app
