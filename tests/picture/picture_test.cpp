// Tests four scenes' pictures and ray counts at 64x64 against the C++ reference renderer, which shares no
// code.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "tests/picture/agreement.h"
#include "tests/support/catch.h"

using namespace glint;
using pipeline::Workload;
using test::Agreement;
using test::Oracle;

namespace {

constexpr uint32_t kSize = 64;

Agreement agreement(const std::string& scene, Workload workload, uint32_t bounces, Oracle oracle) {
  return test::agreements(scene, {}, kSize, {{workload, bounces, oracle}}).front();
}

std::string any_scene() {
  return GENERATE("WKND", "SHIP", "BUNNY", "REF");
}

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
