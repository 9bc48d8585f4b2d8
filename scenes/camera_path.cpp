// Interpolates between the keys of a camera path.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/camera_path.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace glint::scenes {
namespace {

constexpr size_t kParts = 10;  // of a key: three vectors and an angle

using Parts = std::array<double, kParts>;

Parts parts_of(const PathKey& key) {
  Parts out{};
  for (size_t i = 0; i < 3; ++i) out[i] = key.eye[i], out[3 + i] = key.target[i], out[6 + i] = key.up[i];
  out[9] = key.field_of_view;
  return out;
}

class MotionWithPath final : public Motion {
 public:
  MotionWithPath(std::shared_ptr<const Motion> other, CameraPath path)
      : other_(std::move(other)), path_(std::move(path)) {}
  double seconds() const override { return std::max(other_ ? other_->seconds() : 0.0, path_.seconds()); }
  std::vector<uint32_t> deformed() const override {
    return other_ ? other_->deformed() : std::vector<uint32_t>{};
  }
  void pose(Scene& scene, double seconds) const override {
    if (other_) other_->pose(scene, seconds);
    path_.place(scene.camera, seconds);
  }

 private:
  const std::shared_ptr<const Motion> other_;
  const CameraPath path_;
};

}  // namespace

std::shared_ptr<const Motion> with_camera_path(std::shared_ptr<const Motion> other, CameraPath path) {
  return std::make_shared<MotionWithPath>(std::move(other), std::move(path));
}

void CameraPath::place(Camera& camera, double seconds) const {
  const double time = std::clamp(seconds, keys.front().seconds, keys.back().seconds);
  size_t next = 1;
  while (next + 1 < keys.size() && keys[next].seconds <= time) ++next;
  const PathKey &from = keys[next - 1], &to = keys[next];
  const double span = to.seconds - from.seconds, u = (time - from.seconds) / span;
  const Parts begin = parts_of(from), end = parts_of(to);
  // Returns the slope at a key, as the change over the span between `from` and `to`.
  const auto slope_at = [&](size_t key) {
    const size_t low = key > 0 ? key - 1 : 0, high = std::min(key + 1, keys.size() - 1);
    const Parts a = parts_of(keys[low]), b = parts_of(keys[high]);
    Parts out{};
    for (size_t i = 0; i < kParts; ++i)
      out[i] = (b[i] - a[i]) / (keys[high].seconds - keys[low].seconds) * span;
    return out;
  };
  const Parts begin_slope = slope_at(next - 1), end_slope = slope_at(next);
  Parts at{};
  for (size_t i = 0; i < kParts; ++i) {
    at[i] = begin[i] + (end[i] - begin[i]) * u;
    if (!smooth) continue;
    const double u2 = u * u, u3 = u2 * u;
    at[i] = (2 * u3 - 3 * u2 + 1) * begin[i] + (u3 - 2 * u2 + u) * begin_slope[i] +
            (3 * u2 - 2 * u3) * end[i] + (u3 - u2) * end_slope[i];
  }
  for (size_t i = 0; i < 3; ++i) {
    camera.eye[i] = float(at[i]), camera.target[i] = float(at[3 + i]), camera.up[i] = float(at[6 + i]);
  }
  camera.field_of_view = float(at[9]);
}

}  // namespace glint::scenes
