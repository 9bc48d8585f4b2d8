// Changes the camera of a scene.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/overrides.h"

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <string_view>
#include <system_error>

#include "base/diagnostics.h"
#include "scenes/camera.h"

namespace glint::scenes {
namespace {

constexpr float kFarthest = 1e9f;  // world units; squares of longer vectors leave the range of a float

// Returns numbers that commas separate. They are empty unless each has the form of a number in the range.
std::vector<float> numbers_in(std::string_view text, float low, float high) {
  std::vector<float> out;
  while (true) {
    float value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || !(value >= low && value <= high)) return {};
    out.push_back(value);
    text.remove_prefix(size_t(end - text.data()));
    if (text.empty()) return out;
    if (text.front() != ',') return {};
    text.remove_prefix(1);
  }
}

struct CameraKey {
  std::string_view key, option;
  Vec3 Camera::*place;  // null: the field of view
};
constexpr CameraKey kCameraKeys[] = {{"camera.eye", "--eye", &Camera::eye},
                                     {"camera.look-at", "--look-at", &Camera::target},
                                     {"camera.up", "--up", &Camera::up},
                                     {"camera.fov", "--fov", nullptr}};

void override_camera(Camera& camera, const CameraKey& key, const std::string& value) {
  const std::vector<float> numbers = numbers_in(value, -kFarthest, kFarthest);
  if (key.place) {
    if (numbers.size() != 3)
      throw UserError({}, fmt::format("{} is '{}', expected X,Y,Z in world units", key.option, value),
                      fmt::format("for example {} 0,1.5,-4", key.option));
    camera.*key.place = {numbers[0], numbers[1], numbers[2]};
    return;
  }
  if (numbers.size() != 1 || numbers[0] <= 0 || numbers[0] >= 180)
    throw UserError({}, fmt::format("{} is '{}', expected degrees above 0 and below 180", key.option, value),
                    "it is the angle from the lower edge of the picture to the upper one");
  camera.field_of_view = numbers[0];
}

void check_camera(const Camera& camera) {
  const auto text = [](const Vec3& v) { return fmt::format("{},{},{}", v[0], v[1], v[2]); };
  const Vec3 view = camera.target - camera.eye;
  if (glm::dot(view, view) == 0)
    throw UserError({}, fmt::format("the camera at {} looks at its own place", text(camera.eye)),
                    "--eye and --look-at must name two places");
  const Vec3 side = glm::cross(view, camera.up);
  // Directions closer than 1/1000 give a picture whose rotation is chance.
  if (!(glm::dot(side, side) > 1e-6f * glm::dot(view, view) * glm::dot(camera.up, camera.up)))
    throw UserError({},
                    fmt::format("the camera looks along {}, which is also its upward direction {}",
                                text(view), text(camera.up)),
                    "--up gives another upward direction");
  const CameraMatrices matrices = camera_matrices(camera, 1);
  for (const Mat4& m :
       {matrices.model_view, matrices.projection, matrices.model_view_inverse, matrices.projection_inverse})
    for (size_t c = 0; c < 4; ++c)
      for (size_t r = 0; r < 4; ++r)
        if (!std::isfinite(m[c][r]))
          throw UserError({}, fmt::format("the camera at {} that looks at {} is out of range",
                                          text(camera.eye), text(camera.target)));
}

}  // namespace

void override_scene(Scene& scene, const std::vector<Override>& overrides) {
  bool is_moved = false;
  for (const auto& [key, value] : overrides) {
    const CameraKey* found = nullptr;
    for (const CameraKey& one : kCameraKeys)
      if (one.key == key) found = &one;
    if (!found) throw UserError({}, fmt::format("'{}' is not a part of a scene", key));
    override_camera(scene.camera, *found, value);
    is_moved = true;
  }
  if (is_moved) check_camera(scene.camera);
}

}  // namespace glint::scenes
