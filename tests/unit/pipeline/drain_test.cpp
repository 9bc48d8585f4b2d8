// Tests that a frame comes out the same when its scene's contents are freed on the way, on several threads,
// and when the scene comes from a store.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/scene_store.h"
#include "tests/support/catch.h"
#include "tests/support/small_jobs.h"
#include "tests/support/temporary_folder.h"

namespace glint::pipeline {
namespace {

TEST_CASE("a frame is the same when the contents of its scene are freed once they are uploaded") {
  RenderJob job = test::small_job("BUNNY", Workload::Shadow, 8, 1);
  job.scene.textures.push_back({"unused", 1, 1, {1, 2, 3, 4}});
  const RenderResult kept = render(job);
  for (const uint32_t threads : {1u, 2u, 5u}) {
    RenderJob drained = job;
    drained.threads = threads;
    const RenderResult result = render_and_drain(drained);
    CHECK(result.rgba == kept.rgba);
    CHECK(result.cycles == kept.cycles);
    CHECK(result.structures.bytes == kept.structures.bytes);
    CHECK(result.structures.triangles == job.scene.triangles());
    for (const scenes::Model& model : drained.scene.models)
      CHECK(model.vertices.capacity() + model.indices.capacity() == 0);
    CHECK(drained.scene.textures[0].rgba.capacity() == 0);
  }
}

TEST_CASE(
    "a frame of a scene from the store is the same, whether simulated memory takes its pages or copies "
    "them") {
  const test::TemporaryFolder folder;
  scenes::SceneStore store({.folder = folder.path.string(), .build = "build", .least_bytes = 1});
  for (const char* name : {"BUNNY", "CHSNT"}) {
    CAPTURE(name);
    const RenderJob made = test::small_job(name, Workload::Shadow, 8, 1);
    const RenderResult expected = render(made);
    for (int turn = 0; turn < 2; ++turn) {
      RenderJob kept = made;
      kept.scene = scenes::load_scene(name, {.store = &store});
      REQUIRE(kept.scene.packed);
      for (const bool drains : {false, true}) {
        const RenderResult result = drains ? render_and_drain(kept) : render(kept);
        CHECK(result.rgba == expected.rgba);
        CHECK(result.cycles == expected.cycles);
        CHECK(result.structures.triangles == expected.structures.triangles);
      }
    }
  }
}

}  // namespace
}  // namespace glint::pipeline
