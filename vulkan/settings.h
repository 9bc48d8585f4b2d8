// Reads what the user asks of the driver. Its environment is the driver's command line.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "exec/fault.h"
#include "pipeline/params.h"
#include "pipeline/run_profile.h"
#include "setup/launch_selection.h"
#include "vulkan/frames.h"

namespace glint::vulkan {

struct Settings {
  std::string preset;                            // GLINT_CONFIG: a preset ("mobile") or a file
  pipeline::GpuParams gpu;                       // the preset, with the settings of GLINT_SET on top
  setup::LaunchSelection timing;                 // GLINT_TIMING: the launches that the timing machine runs
  std::string timing_text;                       // the same as it was written
  setup::LaunchSelection save;                   // GLINT_VK_SAVE: the launches that become capsules
  std::string out;                               // GLINT_OUT: the folder of the application; "" for a name
  pipeline::Observation observe;                 // GLINT_OBSERVE: what to write of timed launches besides
  bool is_compact = false;                       // GLINT_STATS: "full" or "compact", as `glint run --stats`
  bool tells_progress = false;                   // GLINT_PROGRESS: a file tells how far a timed launch is
  uint32_t threads = 1;                          // GLINT_THREADS: threads of the host for a launch
  exec::OnFault on_fault = exec::OnFault::Warn;  // GLINT_ON_FAULT: "warn" or "stop"
  // GLINT_VK_QUEUE: "compute" or "universal". With the latter the device pretends to have graphics, for
  // programs that want a queue with graphics and then only compute.
  bool is_universal = false;
  PictureChoice pictures;          // GLINT_VK_PRESENT: the presented frames that become pictures
  bool asks_for_pictures = false;  // whether GLINT_VK_PRESENT is set
};

// Returns the settings of the process. Throws UserError that names the variable and what it may be.
Settings settings_of_environment();

}  // namespace glint::vulkan
