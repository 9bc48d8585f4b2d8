// Declares `glint run SCENE`, which renders one frame of a scene on the simulated GPU.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "apps/glint/run/launch_options.h"
#include "apps/glint/session.h"
#include "scenes/camera.h"

namespace glint::app {

struct SceneOptions {
  std::string scene, shader = "pt", size = "128x128";
  std::string assets;      // folder of original scene data; empty: none
  std::string shader_dir;  // empty: the workload's own shaders
  bool instancing = false, shader_given = false;
  bool exr = false;  // also keep the picture as image.exr
  scenes::RenderParams frame;
};

Exit run_scene(const Session& session, SceneOptions options, const LaunchOptions& launch);

}  // namespace glint::app
