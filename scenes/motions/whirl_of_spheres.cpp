// Moves the small spheres of WKND.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <vector>

#include "scenes/mesh.h"
#include "scenes/motions/built_in.h"

namespace glint::scenes {
namespace {

constexpr float kSmall = 0.5f;    // world units; larger spheres stand still
constexpr float kHop = 0.5f;      // world units, the height of a hop
constexpr double kTurn = 1.2;     // radians a second, in the middle
constexpr float kHalfSpeed = 4;   // world units from the middle: there spheres go half as fast
constexpr uint32_t kRhythms = 3;  // A sphere hops one to three times a second.

class WhirlOfSpheres final : public Motion {
 public:
  explicit WhirlOfSpheres(const Scene& scene) {
    for (uint32_t i = 0; i < scene.models.size(); ++i)
      if (const Model& model = scene.models[i]; model.is_procedural() && model.radius < kSmall)
        spheres_.push_back({i, model.center});
  }
  double seconds() const override { return kSeconds; }
  std::vector<uint32_t> deformed() const override {
    std::vector<uint32_t> out;
    for (const Sphere& sphere : spheres_) out.push_back(sphere.model);
    return out;
  }
  void pose(Scene& scene, double seconds) const override {
    const double time = seconds < 0 ? 0 : seconds > kSeconds ? kSeconds : seconds;
    for (const Sphere& sphere : spheres_) {
      const Vec3& at = sphere.center;
      const double far = std::sqrt(double(at[0]) * at[0] + double(at[2]) * at[2]);
      const double angle = time * kTurn / (1 + far / kHalfSpeed);
      const float c = cosine(angle), s = sine(angle);
      const float hop = sine(std::numbers::pi * time * (1 + sphere.model % kRhythms));
      scene.models[sphere.model].center = {c * at[0] + s * at[2], at[1] + kHop * (hop < 0 ? -hop : hop),
                                           c * at[2] - s * at[0]};
    }
  }

 private:
  static constexpr double kSeconds = 2;
  struct Sphere {
    uint32_t model;
    Vec3 center;  // as loaded
  };
  std::vector<Sphere> spheres_;
};

}  // namespace

std::shared_ptr<const Motion> whirl_of_spheres(const Scene& scene) {
  return std::make_shared<WhirlOfSpheres>(scene);
}

}  // namespace glint::scenes
