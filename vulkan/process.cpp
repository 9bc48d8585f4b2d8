// Says what the process is that has loaded the driver.
// SPDX-License-Identifier: Apache-2.0
#include "vulkan/process.h"

#include <cctype>
#include <filesystem>
#include <sstream>

#include "setup/resources.h"

namespace glint::vulkan {

std::vector<std::string> command_of_process() {
  std::istringstream text(setup::text_of_file("/proc/self/cmdline").value_or(""));
  std::vector<std::string> out;
  for (std::string word; std::getline(text, word, '\0');) out.push_back(word);
  return out;
}

std::string program_of_process() {
  const std::vector<std::string> command = command_of_process();
  std::string name = command.empty() ? "" : std::filesystem::path(command[0]).filename().string();
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_' && c != '.') c = '_';
  return name.empty() || name[0] == '.' ? "program" + name : name;
}

std::atomic<uint64_t>& used_by_process() {
  static std::atomic<uint64_t> bytes{0};
  return bytes;
}

}  // namespace glint::vulkan
