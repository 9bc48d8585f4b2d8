// Moves the camera of SPNZA.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/camera_path.h"
#include "scenes/motions/built_in.h"

namespace glint::scenes {
namespace {

class Walk final : public Motion {
 public:
  explicit Walk(const Camera& camera) {
    const auto add = [&](double seconds, const Vec3& eye, const Vec3& target) {
      path_.keys.push_back({seconds, eye, target, camera.up, camera.field_of_view});
    };
    add(0, camera.eye, camera.target);
    // Lengths are those of the scene, whose hall is some 3,000 long.
    const Vec3 ahead = camera.target - camera.eye;
    add(0.5, camera.eye + Vec3{40, 20, -200}, camera.eye + Vec3{40, 20, -200} + ahead);
    add(1.25, camera.eye + Vec3{-60, 60, -500},
        camera.eye + Vec3{-60, 60, -500} + ahead + Vec3{0.5f, 0.1f, 0});
    add(2, camera.eye + Vec3{-120, 160, -800},
        camera.eye + Vec3{-120, 160, -800} + ahead + Vec3{1, -0.1f, 0});
  }
  double seconds() const override { return path_.seconds(); }
  void pose(Scene& scene, double seconds) const override { path_.place(scene.camera, seconds); }

 private:
  CameraPath path_;
};

}  // namespace

std::shared_ptr<const Motion> walk_through_sponza(const Scene& scene) {
  return std::make_shared<Walk>(scene.camera);
}

}  // namespace glint::scenes
