// Runs a Vulkan program on Glint's driver, and says at the end what it did there.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/glint/session.h"

namespace glint::app {

struct VulkanProgram {
  std::vector<std::string> command;       // the program and its arguments
  std::string timing, save, config, out;  // as GLINT_TIMING, GLINT_VK_SAVE and so on take them
  std::vector<std::string> settings;      // keys on top of the configuration
  std::string on_fault = "warn", queue = "compute", stats = "full", present = "last";
  uint32_t threads = 1;
  bool profile = false, heat = false, trace = false;
  uint64_t sample = 0;
  bool no_report = false;
};

// Runs the program, whose only Vulkan driver is Glint's, shows how far timed launches are on a terminal, and
// writes what ran to stderr and into a report. Returns the exit code of the program, as shells give it when a
// signal has ended it. Throws UserError when the driver or the program is not there or an option is wrong.
Exit run_vulkan_program(const Session& session, const VulkanProgram& program);

}  // namespace glint::app
