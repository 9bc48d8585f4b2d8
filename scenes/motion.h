// Declares what moves in a scene: a scene at a time.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace glint::scenes {

// Contract (tests/unit/scenes/motion_test.cpp):
//  - pose() depends on the scene as it was loaded and on the time alone, and never on an earlier pose.
//  - It changes places, normals, centres and radii in the models of deformed(), transforms of instances, and
//    the camera. Numbers of models, vertices, indices and instances stay, and so do indices and materials.
//  - The same time gives the same bits on every machine.
class Motion {
 public:
  virtual ~Motion() = default;
  // Returns the end of the motion. It begins at 0.
  virtual double seconds() const = 0;
  // Returns the models that pose() changes, in rising order.
  virtual std::vector<uint32_t> deformed() const { return {}; }
  // Brings everything that moves to its place at a time. Before 0 and after the end it is where it is at 0
  // and at the end.
  virtual void pose(Scene& scene, double seconds) const = 0;
};

}  // namespace glint::scenes
