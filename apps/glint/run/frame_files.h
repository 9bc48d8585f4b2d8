// Writes a frame as files that any Vulkan program can draw: shaders, buffers, and frame.json, which says how
// they belong together (docs/frames.md).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "pipeline/render.h"

namespace glint::app {

inline constexpr int kFrameVersion = 1;  // of frame.json

// Holds what one export wrote.
struct FrameFiles {
  uint64_t files = 0, bytes = 0;
};

// Writes the frame of a job into a folder, which is made where it is missing. `name` is the name of the
// frame. Throws UserError when a shader does not compile or a file cannot be written.
FrameFiles write_frame(const pipeline::RenderJob& job, const std::string& name, const std::string& folder);

}  // namespace glint::app
