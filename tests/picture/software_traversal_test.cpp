// Tests that rays walked in code give the pictures of the RT unit, bit for bit, and what cannot be asked for.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string_view>

#include "base/diagnostics.h"
#include "tests/support/catch.h"
#include "tests/support/small_jobs.h"

using namespace glint;
using pipeline::Workload;

namespace {

constexpr uint32_t kSize = 16;

pipeline::RenderResult picture(const std::string& scene, Workload workload, std::string_view unit,
                               bool timing, bool no_skip = false, uint32_t threads = 1) {
  pipeline::RenderJob job = test::small_job(scene, workload, kSize, 1);
  job.gpu.rt.unit = unit;
  job.timing = timing;
  job.no_skip = no_skip;
  job.threads = threads;
  return pipeline::render(job);
}

std::string error_of(const std::string& format, const std::string& any_hit) {
  pipeline::RenderJob job = test::small_job("WKND", Workload::Shadow, 8, 1);
  job.gpu.rt.unit = rt::kSoftware;
  job.gpu.bvh.format.name = format;
  job.gpu.rt.any_hit.name = any_hit;
  try {
    pipeline::render(job);
  } catch (const UserError& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("pictures are the RT unit's, bit for bit, when both machines walk rays in code") {
  const std::string scene = GENERATE("WKND", "SHIP", "BUNNY");
  for (const Workload workload : {Workload::PathTracing, Workload::Shadow, Workload::AmbientOcclusion}) {
    INFO(scene << ' ' << int(workload));
    const pipeline::RenderResult unit = picture(scene, workload, rt::kHardware, false),
                                 code = picture(scene, workload, rt::kSoftware, false);
    CHECK(unit.rgba == code.rgba);
    CHECK(code.rays.nodes == 0);  // the shared traversal has walked none
    CHECK(code.lane_instructions > 2 * unit.lane_instructions);
    CHECK(picture(scene, workload, rt::kSoftware, true).rgba == unit.rgba);
  }
}

TEST_CASE("with rays in code skipping and stepping, one thread and two, take the same cycles") {
  const pipeline::RenderResult skipped = picture("WKND", Workload::PathTracing, rt::kSoftware, true);
  CHECK(picture("WKND", Workload::PathTracing, rt::kSoftware, true, true).cycles == skipped.cycles);
  CHECK(picture("WKND", Workload::PathTracing, rt::kSoftware, true, false, 2).cycles == skipped.cycles);
}

TEST_CASE("the RT unit does nothing when rays are walked in code") {
  const pipeline::RenderResult unit = picture("WKND", Workload::Shadow, rt::kHardware, true),
                               code = picture("WKND", Workload::Shadow, rt::kSoftware, true);
  CHECK(unit.rays.nodes > 0);
  CHECK(code.rays.nodes == 0);
}

TEST_CASE("node formats and any-hit modes that the traversal program lacks are refused by their keys") {
  CHECK(error_of("bvh6", "immediate") == "none");
  CHECK(error_of("bvh8", "immediate").find("'bvh.format' is \"bvh8\"") != std::string::npos);
  CHECK(error_of("bvh6", "deferred").find("'rt.any_hit' is \"deferred\"") != std::string::npos);
}
