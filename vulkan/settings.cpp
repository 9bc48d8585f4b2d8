// Reads what the user asks of the driver. Its environment is the driver's command line.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/settings.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>
#include <sstream>
#include <string>
#include <string_view>
#include <unistd.h>
#include <vector>

#include "base/diagnostics.h"
#include "setup/config.h"

namespace glint::vulkan {
namespace {

constexpr uint32_t kMostThreads = 1024;

// Returns the value of a variable, or "" when it is not set.
std::string value_of(const char* variable) {
  const char* const value = std::getenv(variable);
  return value ? value : "";
}

uint32_t threads_of(const std::string& text) {
  uint32_t out = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc() || end != text.data() + text.size() || out == 0 || out > kMostThreads)
    throw UserError(
        fmt::format("GLINT_THREADS is '{}': it has to be a number from 1 to {}", text, kMostThreads));
  return out;
}

exec::OnFault on_fault_of(const std::string& text) {
  for (const exec::OnFault each : {exec::OnFault::Stop, exec::OnFault::Warn})
    if (text == exec::name_of(each)) return each;
  throw UserError(fmt::format("GLINT_ON_FAULT is '{}': it has to be 'warn' or 'stop'", text));
}

// Returns the words of a text.
std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

pipeline::Observation observation_of(const std::string& text) {
  pipeline::Observation out;
  for (const std::string& word : words_of(text)) {
    const char* const digits = word.data() + std::min<size_t>(word.size(), 7);
    if (word == "profile") {
      out.profile = true;
    } else if (word == "heat") {
      out.heat = true;
    } else if (word == "trace") {
      out.trace.wanted = true;
    } else if (const auto [end, error] = std::from_chars(digits, word.data() + word.size(), out.sample);
               word.rfind("sample=", 0) != 0 || error != std::errc() || end != word.data() + word.size() ||
               out.sample == 0) {
      throw UserError(
          fmt::format("GLINT_OBSERVE: '{}' is none of 'profile', 'sample=CYCLES', 'heat' and 'trace'", word));
    }
  }
  return out;
}

bool is_compact(const std::string& text) {
  if (text != "full" && text != "compact")
    throw UserError(fmt::format("GLINT_STATS is '{}': it has to be 'full' or 'compact'", text));
  return text == "compact";
}

bool is_universal(const std::string& text) {
  if (text != "compute" && text != "universal")
    throw UserError(fmt::format("GLINT_VK_QUEUE is '{}': it has to be 'compute' or 'universal'", text));
  return text == "universal";
}

// Refuses a variable that begins as the driver's do and that nobody reads, because its name is wrong.
void check_names() {
  const std::vector<std::string> known = {"GLINT_CONFIG",   "GLINT_OBSERVE",    "GLINT_ON_FAULT",
                                          "GLINT_OUT",      "GLINT_PROGRESS",   "GLINT_SET",
                                          "GLINT_STATS",    "GLINT_THREADS",    "GLINT_TIMING",
                                          "GLINT_VK_QUEUE", "GLINT_VK_PRESENT", "GLINT_VK_SAVE"};
  for (char** each = environ; *each; ++each) {
    const std::string_view entry(*each);
    const std::string name(entry.substr(0, entry.find('=')));
    if (!name.starts_with("GLINT_VK_") || std::ranges::count(known, name)) continue;
    const std::string meant = nearest(name, known);
    throw UserError(fmt::format("{} is no variable of the driver; {}", name,
                                meant.empty() ? fmt::format("it has {}", fmt::join(known, ", "))
                                              : fmt::format("did you mean {}?", meant)));
  }
}

// Returns what Glint was installed with, which lies beside this library.
setup::Resources resources() {
  Dl_info library{};
  if (dladdr(reinterpret_cast<const void*>(&settings_of_environment), &library) == 0 || !library.dli_fname)
    throw UserError("the driver does not know where it lies");
  return setup::Resources::find(library.dli_fname);
}

void read_machine(Settings& settings) {
  const std::string name = value_of("GLINT_CONFIG");
  try {
    const std::string preset = name.empty() ? "mobile" : name;
    settings.gpu = setup::read_preset(resources(), preset, words_of(value_of("GLINT_SET")));
    settings.preset = std::filesystem::path(preset).stem().string();
  } catch (const UserError& error) {
    throw UserError(fmt::format("GLINT_CONFIG and GLINT_SET make no machine:\n{}", error.what()));
  }
}

}  // namespace

Settings settings_of_environment() {
  check_names();
  Settings out;
  read_machine(out);
  out.timing_text = value_of("GLINT_TIMING");
  out.timing = setup::LaunchSelection::parse(out.timing_text, "GLINT_TIMING");
  out.save = setup::LaunchSelection::parse(value_of("GLINT_VK_SAVE"), "GLINT_VK_SAVE");
  out.out = value_of("GLINT_OUT");
  out.observe = observation_of(value_of("GLINT_OBSERVE"));
  if (const std::string text = value_of("GLINT_STATS"); !text.empty()) out.is_compact = is_compact(text);
  out.tells_progress = !value_of("GLINT_PROGRESS").empty();
  if (const std::string text = value_of("GLINT_THREADS"); !text.empty()) out.threads = threads_of(text);
  if (const std::string text = value_of("GLINT_ON_FAULT"); !text.empty()) out.on_fault = on_fault_of(text);
  if (const std::string text = value_of("GLINT_VK_QUEUE"); !text.empty())
    out.is_universal = is_universal(text);
  const std::string pictures = value_of("GLINT_VK_PRESENT");
  out.pictures = PictureChoice::parse(pictures, "GLINT_VK_PRESENT"),
  out.asks_for_pictures = !pictures.empty();
  return out;
}

}  // namespace glint::vulkan
