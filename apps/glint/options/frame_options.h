// Declares the options of a frame and of the scene that it shows, which `run` and `bench` share.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "apps/glint/options/command_line.h"
#include "scenes/camera.h"
#include "scenes/overrides.h"

namespace glint::app {

struct FrameOptions {
  scenes::RenderParams params;         // samples and the like; size and window are those of the texts below
  std::string size = "128x128", crop;  // the window is empty for the whole frame
  std::string eye, look_at, up, fov;   // of the camera; empty: as the scene has it
  std::vector<std::string> light, materials;  // KEY=VALUE, NAME.KEY=VALUE

  // Returns the parameters with size and window. Throws UserError where a text is neither.
  scenes::RenderParams frame() const;
  // Returns what the options change of a scene. Throws UserError for texts of another form.
  std::vector<scenes::Override> overrides() const;
  // Returns the first option that was given and has no meaning for what is not a scene, or "".
  std::string given() const;
  // Returns all of them as words of a command line.
  std::vector<std::string> arguments() const;
};

void add_frame_options(Command command, FrameOptions& options);

}  // namespace glint::app
