// Deforms the largest model of a scene.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "scenes/mesh.h"
#include "scenes/motions/built_in.h"

namespace glint::scenes {
namespace {

constexpr double kTwist = 1.1;    // radians at the top
constexpr float kSway = 0.35f;    // part of the height by which the top moves aside
constexpr float kSquash = 0.18f;  // part of the height

class SwayingModel final : public Motion {
 public:
  explicit SwayingModel(const Scene& scene) {
    for (uint32_t i = 0; i < scene.models.size(); ++i)
      if (scene.models[i].indices.size() > scene.models[model_].indices.size()) model_ = i;
    rest_ = scene.models[model_].vertices;
    box_ = bounds(scene.models[model_]);
  }
  double seconds() const override { return kSeconds; }
  std::vector<uint32_t> deformed() const override { return {model_}; }
  void pose(Scene& scene, double seconds) const override {
    Model& model = scene.models[model_];
    model.vertices = rest_;
    const double time = std::min(seconds, kSeconds);
    if (time <= 0) return;
    const float sway = kSway * sine(2 * std::numbers::pi * time / kSeconds),
                high = 1 + kSquash * sine(4 * std::numbers::pi * time / kSeconds),
                wide = 1 / std::sqrt(high);  // The volume stays.
    const double twist = kTwist * std::sin(2 * std::numbers::pi * time / kSeconds);
    const Vec3 foot{(box_.lower[0] + box_.upper[0]) / 2, box_.lower[1], (box_.lower[2] + box_.upper[2]) / 2};
    const float height = box_.upper[1] - box_.lower[1];
    for (Vertex& vertex : model.vertices) {
      const Vec3 at = vertex.position - foot;
      const float up = at[1] / height, bent = up * up;
      const float c = cosine(twist * double(bent)), s = sine(twist * double(bent));
      vertex.position = foot + Vec3{wide * (c * at[0] + s * at[2]) + sway * height * bent, high * at[1],
                                    wide * (c * at[2] - s * at[0])};
    }
    compute_smooth_normals(model);
  }

 private:
  static constexpr double kSeconds = 2;

  uint32_t model_ = 0;
  std::vector<Vertex> rest_;
  Bounds box_;
};

}  // namespace

std::shared_ptr<const Motion> swaying_model(const Scene& scene) {
  return std::make_shared<SwayingModel>(scene);
}

}  // namespace glint::scenes
