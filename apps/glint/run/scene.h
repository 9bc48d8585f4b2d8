// Declares `glint run SCENE`, which renders one frame of a scene on the simulated GPU.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "apps/glint/run/launch_options.h"
#include "apps/glint/session.h"
#include "scenes/camera.h"
#include "scenes/overrides.h"

namespace glint::app {

struct SceneOptions {
  std::string scene, shader = "pt", size = "128x128";
  std::string assets;      // folder of original scene data; empty: none
  std::string shader_dir;  // empty: the workload's own shaders
  bool instancing = false, shader_given = false;
  bool exr = false;  // also keep the picture as image.exr
  scenes::RenderParams frame;
  std::string crop;                                 // window of the frame; empty: all of it
  std::string eye, look_at, up, fov;                // of the camera; empty: as the scene has it
  std::vector<std::string> light, materials;        // KEY=VALUE, NAME.KEY=VALUE
  std::vector<scenes::Override> overrides() const;  // what these change
  // Returns the first option that was given and has no meaning for what is not a scene, or "".
  std::string given() const;
};

Exit run_scene(const Session& session, SceneOptions options, const LaunchOptions& launch);

}  // namespace glint::app
