// Tests that a frame comes out the same when its scene's contents are freed on the way, and on several
// threads.
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.h"
#include "tests/support/small_jobs.h"

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

}  // namespace
}  // namespace glint::pipeline
