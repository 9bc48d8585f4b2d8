// Pictures and ray counts against the plain C++ reference renderer, which shares no code with the machine.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "pipeline/render.h"
#include "tests/reference/reference.h"
#include "tests/support/catch.h"
#include "tests/support/scene_data.h"
#include "tests/support/small_jobs.h"

using namespace glint;
using pipeline::Workload;

namespace {

constexpr uint32_t kSize = 64, kSamples = 2;

struct Agreement {
  double pixels = 0;      // fraction whose channels agree within 1e-3 relative
  double ray_ratio = 0;   // rays of the machine / rays of the reference
  double mean_error = 0;  // largest relative difference of a channel's mean over the picture
};

bool close(float a, float b) { return std::abs(a - b) <= 1e-3f * std::max(std::abs(b), 1e-3f); }

Agreement compare(const pipeline::RenderResult& picture, const reference::ReferenceResult& expected) {
  Agreement out;
  size_t agree = 0;
  double mean[3] = {}, expected_mean[3] = {};
  for (size_t i = 0; i < expected.sum.size(); ++i) {
    const float* got = &picture.accumulation[4 * i];
    const float want[3] = {expected.sum[i].x, expected.sum[i].y, expected.sum[i].z};
    bool all = true;
    for (int c = 0; c < 3; ++c) {
      all = all && close(got[c], want[c]);
      mean[c] += double(got[c]);
      expected_mean[c] += double(want[c]);
    }
    agree += all;
  }
  for (int c = 0; c < 3; ++c)
    out.mean_error = std::max(out.mean_error, std::abs(mean[c] - expected_mean[c]) / std::max(expected_mean[c], 1e-9));
  out.pixels = double(agree) / double(expected.sum.size());
  out.ray_ratio = double(picture.rays.rays) / double(expected.rays);
  return out;
}

enum class Oracle { Embree, Exact };

Agreement agreement(const std::string& scene, Workload workload, uint32_t bounces, Oracle oracle,
                    const std::string& assets = {}) {
  pipeline::RenderJob job = test::small_job(scene, workload, kSize, kSamples, assets);
  job.timing = false;  // the timing machine gives the same bytes: tests/cosim
  job.frame.bounces = bounces;
  auto intersector = oracle == Oracle::Embree ? reference::make_embree_intersector(job.scene)
                                              : reference::make_exact_intersector(job.scene);
  const Agreement out = compare(pipeline::render(job), reference::render(job.scene, workload, job.frame, *intersector));
  std::cout << scene << ' ' << test::shader_folder(workload) << " bounces " << bounces
            << (oracle == Oracle::Embree ? " Embree" : " exact") << ": " << 100 * out.pixels << " % of pixels agree, rays x"
            << out.ray_ratio << ", mean colour " << 100 * out.mean_error << " % off\n";
  return out;
}

std::string any_scene() { return GENERATE("WKND", "SHIP", "BUNNY", "REF"); }

}  // namespace

TEST_CASE("shadow pictures agree with Embree's on 99.5 % of pixels with equal ray counts") {
  const Agreement a = agreement(any_scene(), Workload::Shadow, 16, Oracle::Embree);
  CHECK(a.pixels >= 0.995);
  CHECK(std::abs(a.ray_ratio - 1) < 1e-3);
}

TEST_CASE("ambient occlusion pictures agree with Embree's on 99.5 % of pixels with equal ray counts") {
  const Agreement a = agreement(any_scene(), Workload::AmbientOcclusion, 16, Oracle::Embree);
  CHECK(a.pixels >= 0.995);
  CHECK(std::abs(a.ray_ratio - 1) < 1e-3);
}

TEST_CASE("two-bounce path tracing agrees with Embree on 99.5 % of pixels") {
  const Agreement a = agreement(any_scene(), Workload::PathTracing, 2, Oracle::Embree);
  CHECK(a.pixels >= 0.995);
  CHECK(std::abs(a.ray_ratio - 1) < 1e-3);
}

TEST_CASE("full path tracing agrees with the exact reference on 99.5 % of pixels") {
  const Agreement a = agreement(any_scene(), Workload::PathTracing, 16, Oracle::Exact);
  CHECK(a.pixels >= 0.995);
}

TEST_CASE("full path tracing has Embree's mean colour within 1 % and its ray count within 0.5 %") {
  const Agreement a = agreement(any_scene(), Workload::PathTracing, 16, Oracle::Embree);
  CHECK(a.mean_error <= 0.01);
  CHECK(std::abs(a.ray_ratio - 1) <= 0.005);
}

TEST_CASE("generated scenes of one structure and of many agree with Embree's pictures on 99.5 % of pixels") {
  const std::string scene = GENERATE("BATH", "CRNVL", "FOX", "PARTY");
  const auto workload = GENERATE(Workload::Shadow, Workload::AmbientOcclusion);
  const Agreement a = agreement(scene, workload, 16, Oracle::Embree);
  CHECK(a.pixels >= 0.995);
  CHECK(std::abs(a.ray_ratio - 1) < 1e-3);
}

TEST_CASE("shadow and ambient occlusion of the original ship agree with Embree's on 99.5 % of pixels") {
  const test::SceneData data("SHIP");
  if (data.path.empty()) return;
  const auto workload = GENERATE(Workload::Shadow, Workload::AmbientOcclusion);
  const Agreement a = agreement("SHIP", workload, 16, Oracle::Embree, data.path);
  CHECK(a.pixels >= 0.995);
  CHECK(std::abs(a.ray_ratio - 1) < 1e-3);
}

// 909 of the mesh's 6,255 triangles lie exactly on another that faces the other way. Which of the two a ray meets decides
// whether its path goes on, and Embree leaves that open (92 % of pixels agree with its choice): so this is compared with
// the reference that has Glint's rule, the lowest primitive.
TEST_CASE("path tracing of the original ship agrees with the exact reference on 99.5 % of pixels") {
  const test::SceneData data("SHIP");
  if (data.path.empty()) return;
  const auto bounces = GENERATE(2u, 16u);
  const Agreement a = agreement("SHIP", Workload::PathTracing, bounces, Oracle::Exact, data.path);
  CHECK(a.pixels >= 0.995);
  CHECK(std::abs(a.ray_ratio - 1) < 1e-3);
}
