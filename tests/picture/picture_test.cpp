// Tests four scenes' pictures and ray counts at 64x64 against the C++ reference renderer, which shares no
// code.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "tests/picture/agreement.h"
#include "tests/support/catch.h"

using namespace glint;
using pipeline::Workload;
using test::Agreement;
using test::Oracle;

namespace {

constexpr uint32_t kSize = 64;

// The cases of each scene share what it costs to load the scene and to build its structures.
const std::vector<test::Case> kCases = {{Workload::Shadow, 16, Oracle::Embree},
                                        {Workload::AmbientOcclusion, 16, Oracle::Embree},
                                        {Workload::PathTracing, 2, Oracle::Embree},
                                        {Workload::PathTracing, 16, Oracle::Exact},
                                        {Workload::PathTracing, 16, Oracle::Embree}};

// Returns the agreement of any of the scenes in the case of that number.
Agreement agreement(size_t number) {
  static std::map<std::string, std::vector<Agreement>> found;
  const std::string scene = GENERATE("WKND", "SHIP", "BUNNY", "REF");
  if (!found.contains(scene)) found.emplace(scene, test::agreements(scene, {}, kSize, kCases));
  return found.at(scene).at(number);
}

}  // namespace

TEST_CASE("shadow pictures agree with Embree's on 99.5 % of pixels with equal ray counts") {
  const Agreement a = agreement(0);
  CHECK(a.pixels >= 0.995);
  CHECK(std::abs(a.ray_ratio - 1) < 1e-3);
}

TEST_CASE("ambient occlusion pictures agree with Embree's on 99.5 % of pixels with equal ray counts") {
  const Agreement a = agreement(1);
  CHECK(a.pixels >= 0.995);
  CHECK(std::abs(a.ray_ratio - 1) < 1e-3);
}

TEST_CASE("two-bounce path tracing agrees with Embree on 99.5 % of pixels") {
  const Agreement a = agreement(2);
  CHECK(a.pixels >= 0.995);
  CHECK(std::abs(a.ray_ratio - 1) < 1e-3);
}

TEST_CASE("full path tracing agrees with the exact reference on 99.5 % of pixels") {
  const Agreement a = agreement(3);
  CHECK(a.pixels >= 0.995);
}

TEST_CASE("full path tracing has Embree's mean colour within 1 % and its ray count within 0.5 %") {
  const Agreement a = agreement(4);
  CHECK(a.mean_error <= 0.01);
  CHECK(std::abs(a.ray_ratio - 1) <= 0.005);
}
