// Options of a frame: samples, rays, seed.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/frame_options.h"

#include "apps/glint/options/command_line.h"

namespace glint::app {

void add_frame_options(Command command, scenes::RenderParams& frame) {
  command.add_option("--spp", frame.samples, "Samples a pixel").in_range(1u, 65536u).capture_default_str();
  command.add_option("--bounces", frame.bounces, "Longest path of pt, in rays")
      .in_range(1u, 1000u)
      .capture_default_str();
  command.add_option("--shadow-rays", frame.shadow_rays, "Shadow rays a hit of sh")
      .in_range(1u, 4096u)
      .capture_default_str();
  command.add_option("--ao-rays", frame.ao_rays, "Occlusion rays a hit of ao")
      .in_range(1u, 4096u)
      .capture_default_str();
  command.add_option("--seed", frame.seed, "Seed of the pixel jitter").capture_default_str();
}

}  // namespace glint::app
