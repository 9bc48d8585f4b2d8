// Reads files of camera paths.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "scenes/camera_path.h"

namespace glint::pipeline {

// Reads a TOML file (docs/animation.md): [[key]] with `time` in seconds, `eye`, `target`, `up`, `fov`, and
// `interpolation`. What a key does not give of the last two is that of `camera`. Throws UserError with the
// place of every mistake: unknown keys, fewer than two keys, times that do not rise, and cameras that see
// nothing.
scenes::CameraPath read_camera_path(const std::string& path, const scenes::Camera& camera);

}  // namespace glint::pipeline
