// Tests that scenes at a time depend on the time alone, and that camera paths go through their keys.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/motion.h"

#include <cstring>
#include <string>

#include "scenes/camera_path.h"
#include "tests/support/catch.h"

namespace glint::scenes {
namespace {

Scene moving(const char* name) {
  LoadOptions options;
  options.moving = true;
  return load_scene(name, options);
}

TEST_CASE("every scene that moves is as it was loaded at time 0, and its poses depend on the time alone") {
  CHECK_FALSE(moving("CORNELL").motion);
  for (const SceneInfo& info : scene_list()) {
    if (!info.moves) continue;
    Scene scene = moving(info.name.c_str());
    CAPTURE(info.name);
    REQUIRE(scene.motion);
    const uint64_t loaded = scene.hash();
    scene.motion->pose(scene, 0);
    CHECK(scene.hash() == loaded);
    scene.motion->pose(scene, 0.7);
    const uint64_t posed = scene.hash();
    CHECK(posed != loaded);
    scene.motion->pose(scene, 1.9);
    CHECK(scene.hash() != posed);
    scene.motion->pose(scene, 0.7);
    CHECK(scene.hash() == posed);
    scene.motion->pose(scene, -1);
    CHECK(scene.hash() == loaded);
    scene.motion->pose(scene, scene.motion->seconds());
    const uint64_t end = scene.hash();
    scene.motion->pose(scene, scene.motion->seconds() + 5);
    CHECK(scene.hash() == end);
  }
}

TEST_CASE("only the models that a motion names change their vertices and spheres") {
  for (const char* name : {"WKND", "BUNNY", "SPNZA"}) {
    CAPTURE(name);
    const Scene rest = moving(name);
    Scene posed = rest;
    posed.motion->pose(posed, 0.6);
    std::vector<uint32_t> changed;
    REQUIRE(posed.models.size() == rest.models.size());
    for (uint32_t i = 0; i < rest.models.size(); ++i) {
      REQUIRE(posed.models[i].vertices.size() == rest.models[i].vertices.size());
      CHECK(posed.models[i].indices == rest.models[i].indices);
      const bool same = std::memcmp(posed.models[i].vertices.data(), rest.models[i].vertices.data(),
                                    rest.models[i].vertices.size() * sizeof(Vertex)) == 0;
      if (!same || posed.models[i].center != rest.models[i].center) changed.push_back(i);
    }
    CHECK(changed == posed.motion->deformed());
    CHECK(changed.size() == (std::string(name) == "WKND" ? 483u : std::string(name) == "BUNNY" ? 1u : 0u));
  }
}

CameraPath path_of(bool smooth) {
  CameraPath out;
  out.smooth = smooth;
  out.keys = {{0.5, {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 40},
              {1, {1, 0, 0}, {0, 0, -1}, {0, 1, 0}, 60},
              {3, {1, 4, 0}, {2, 0, -1}, {0, 1, 0}, 60}};
  return out;
}

TEST_CASE("a camera path goes through its keys, and stands before the first and after the last one") {
  for (const bool smooth : {false, true}) {
    const CameraPath path = path_of(smooth);
    CHECK(path.seconds() == 3);
    Camera camera;
    for (const PathKey& key : path.keys) {
      path.place(camera, key.seconds);
      CHECK(camera.eye == key.eye);
      CHECK(camera.target == key.target);
      CHECK(camera.field_of_view == key.field_of_view);
    }
    path.place(camera, 0);
    CHECK(camera.eye == path.keys[0].eye);
    path.place(camera, 9);
    CHECK(camera.eye == path.keys[2].eye);
  }
}

TEST_CASE(
    "between keys a linear path is straight, and a smooth one has the slope of its neighbours at a key") {
  Camera camera;
  path_of(false).place(camera, 2);
  CHECK(camera.eye == Vec3(1, 2, 0));
  CHECK(camera.target == Vec3(1, 0, -1));
  // The slope at the key at 1 s is (4 - 0) / (3 - 0.5) in y, from either side.
  const CameraPath smooth = path_of(true);
  const double step = 1e-3;
  smooth.place(camera, 1 - step);
  CHECK(-camera.eye[1] / step == Approx(1.6).epsilon(0.01));
  smooth.place(camera, 1 + step);
  CHECK(camera.eye[1] / step == Approx(1.6).epsilon(0.01));
}

}  // namespace
}  // namespace glint::scenes
