// Moves a camera through places that are given at times.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <vector>

#include "scenes/motion.h"
#include "scenes/scene.h"

namespace glint::scenes {

// Holds where the camera is at a time. Units are those of Camera.
struct PathKey {
  double seconds = 0;
  Vec3 eye{}, target{}, up{0, 1, 0};
  float field_of_view = 40;
};

// Has two keys or more, whose times rise. Before the first key and after the last one the camera stands.
struct CameraPath {
  // Straight lines between keys; or smooth: a cubic Hermite curve through the keys, whose slope at an inner
  // key is the one from the key before it to the key after it (Catmull and Rom 1974, at the keys' own times),
  // and at an end the one to the neighbour. All four parts of a key move so, component by component.
  bool smooth = true;
  std::vector<PathKey> keys;

  double seconds() const { return keys.back().seconds; }
  // Changes eye, target, up and field of view of a camera.
  void place(Camera& camera, double seconds) const;
};

// Returns a motion whose camera goes along a path; everything else moves as in `other`, which may be null. It
// ends when both have ended.
std::shared_ptr<const Motion> with_camera_path(std::shared_ptr<const Motion> other, CameraPath path);

}  // namespace glint::scenes
