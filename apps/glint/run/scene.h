// Declares `glint run SCENE`, which renders one frame of a scene on the simulated GPU.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "apps/glint/options/frame_options.h"
#include "apps/glint/run/launch_options.h"
#include "apps/glint/session.h"
#include "pipeline/render.h"

namespace glint::app {

struct SceneOptions {
  std::string scene, shader = "pt";
  std::string assets;      // folder of original scene data; empty: none
  std::string shader_dir;  // empty: the workload's own shaders
  bool instancing = false, shader_given = false;
  bool exr = false;  // also keep the picture as image.exr
  FrameOptions frame;
  // Returns the first option that was given and has no meaning for what is not a scene, or "".
  std::string given() const;
};

// Splits the name of a workload into scene and shader set. Throws UserError for files of other kinds, and
// where both the name and --shader say a shader set.
void check_scene(SceneOptions& options);

// Loads the scene and returns the frame that the options ask for, without a machine.
pipeline::RenderJob frame_job(const Session& session, const SceneOptions& options, uint32_t threads);

Exit run_scene(const Session& session, SceneOptions options, const LaunchOptions& launch);

}  // namespace glint::app
