// Launches the frames of a scene on a device.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/device.h"
#include "pipeline/scene_world.h"

namespace glint::pipeline {

// Runs the launch of a scene's world on the machine that the job names. The result has everything. Throws as
// render() does.
RenderResult launch_scene(Device& device, SceneWorld& scene, const RenderJob& job, Caches caches);

}  // namespace glint::pipeline
