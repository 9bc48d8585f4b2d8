// Declares the options of a frame from the list of its parameters.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/frame_options.h"

#include "apps/glint/options/command_line.h"

namespace glint::app {

void add_crop_option(Command command, std::string& crop) {
  command
      .add_option("--crop", crop,
                  "Render only this window of the frame, with the pixels that the whole frame of --size has "
                  "there; X and Y count from the top left")
      .type_name("X,Y,W,H");
}

void add_frame_options(Command command, scenes::RenderParams& frame) {
  for (const scenes::RenderParam& p : scenes::RenderParams::params()) {
    if (p.option.empty()) continue;
    Option option = command.add_option(std::string(p.option), frame.*p.field, std::string(p.doc));
    if (p.max != ~0u) option.in_range(p.min, p.max);
    option.capture_default_str();
  }
}

}  // namespace glint::app
