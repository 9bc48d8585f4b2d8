// Tests the uniform block: where every field lies and what the matrices do.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/camera.h"

#include <cstring>

#include "tests/support/catch.h"

using namespace glint::scenes;

namespace {

template <class T>
T at(const std::vector<std::byte>& block, size_t offset) {
  T value;
  std::memcpy(&value, block.data() + offset, sizeof value);
  return value;
}

// Returns element (row, column) of a * b; both are column-major.
float product(const Mat4& a, const Mat4& b, size_t row, size_t column) {
  float sum = 0;
  for (size_t k = 0; k < 4; ++k) sum += a[k][row] * b[column][k];
  return sum;
}

}  // namespace

TEST_CASE("the uniform block has every field at its std140 offset") {
  const Scene scene = load_scene("CORNELL", {});
  RenderParams params;
  params.width = 64;
  params.height = 32;
  params.samples = 3;
  params.bounces = 5;
  const auto block = uniform_block(scene, Workload::Shadow, params);
  REQUIRE(block.size() == 320);
  CHECK(at<Vec3>(block, 256) == Vec3{280, 500, 400});
  CHECK(at<float>(block, 268) == 10);
  CHECK(at<float>(block, 272) == 0);
  CHECK(at<float>(block, 276) == 10);
  CHECK(at<float>(block, 280) == 1.5f);
  const uint32_t words[] = {3, 3, 5, 2, 1, 64, 32, 0, 0};
  for (size_t i = 0; i < 9; ++i) CHECK(at<uint32_t>(block, 284 + 4 * i) == words[i]);
}

TEST_CASE("the number of secondary rays is the workload's own") {
  const Scene scene = load_scene("CORNELL", {});
  CHECK(frame_uniforms(scene, Workload::PathTracing, {}).secondary_rays == 16);
  CHECK(frame_uniforms(scene, Workload::Shadow, {}).secondary_rays == 2);
  CHECK(frame_uniforms(scene, Workload::AmbientOcclusion, {}).secondary_rays == 4);
}

TEST_CASE("the inverse matrices undo the view and the projection") {
  const Camera camera{.eye = {13, 2, 3}, .target = {0, 0, 0}, .field_of_view = 20};
  const CameraMatrices m = camera_matrices(camera, 1.5f);
  for (size_t row = 0; row < 4; ++row)
    for (size_t column = 0; column < 4; ++column) {
      const float one = row == column;
      CHECK(product(m.model_view, m.model_view_inverse, row, column) == Approx(one).margin(1e-5));
      CHECK(product(m.projection, m.projection_inverse, row, column) == Approx(one).margin(1e-5));
    }
}

TEST_CASE("the projection's inverse maps a corner of the screen to aspect, tangent and -1") {
  const CameraMatrices m = camera_matrices({.eye = {0, 0, 5}, .target = {0, 0, 0}, .field_of_view = 90}, 2);
  const auto row = [&](size_t r) {
    const Mat4& p = m.projection_inverse;
    return p[0][r] * 1 + p[1][r] * 1 + p[2][r] * 1 + p[3][r] * 1;
  };
  CHECK(row(0) == Approx(2));
  CHECK(row(1) == Approx(-1));  // y points down on the screen
  CHECK(row(2) == -1);
}

TEST_CASE("the view's inverse has the eye in its last column and looks along -z") {
  const CameraMatrices m = camera_matrices({.eye = {1, 2, 3}, .target = {1, 2, -9}}, 1);
  CHECK(m.model_view_inverse[3][0] == 1);
  CHECK(m.model_view_inverse[3][1] == 2);
  CHECK(m.model_view_inverse[3][2] == 3);
  CHECK(m.model_view_inverse[2][2] == 1);
  CHECK(m.model_view_inverse[0][0] == 1);
}
