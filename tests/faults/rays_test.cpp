// Tests mistakes with records, structures and depth.
// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/faults.h"
#include "tests/support/catch.h"

namespace glint::test::rays_test {
namespace {

using Catch::Contains;
using exec::FaultKind;

const std::string kPlace = "glsl/faults/rays.rgen:16";
constexpr const char* kClosest = "faults/rays.rchit";

// Runs with two miss records, one callable, and hit records 0 to 3. That of the boxes, 4, and further ones do
// not exist. Nothing lies in columns 0 and 1; quads of records 0 and 1 lie in 2 to 5.
std::vector<uint32_t> run_with(const std::string& closest, const std::string& code, const LabOptions& options,
                               exec::FaultLog& faults) {
  LabShaders shaders{
      "faults/rays.rgen", {"faults/rays.rmiss", "faults/rays.rmiss"}, {}, {}, {"faults/rays.rcall"}};
  for (int record = 0; record < 4; ++record)
    shaders.hit.push_back({record == 0 ? closest : kClosest, "", ""});
  shaders.glsl.defines = {{"WRONG", code}};
  RayLab lab(shaders);
  lab.words_per_lane = 1;
  const std::vector<uint32_t> results = lab.run(options);
  faults = lab.faults;
  return results;
}

std::vector<uint32_t> run_wrong(const std::string& code, const LabOptions& options, exec::FaultLog& faults) {
  return run_with(kClosest, code, options, faults);
}

std::string trace(const std::string& structure, const std::string& miss, const std::string& offset) {
  return "if (id.x < 6u) traceRayEXT(" + structure + ", 0, 0xff, " + offset + ", 1u, " + miss +
         ", origin, 0.0, down, 100.0, 0);";
}
uint32_t column(uint32_t lane) {
  return lane % RayLab::kWidth;
}

}  // namespace

TEST_CASE(
    "a miss record outside of the table is named with the table's size, and calls nothing when let pass") {
  check_mistake({trace("top", "id.y == 3u ? 2u : 1u", "0u"),
                 "needs miss record 2, and the binding table has 2",
                 FaultKind::Record,
                 2,
                 {0, 3, 0},
                 [](uint32_t lane) -> uint32_t {
                   if (column(lane) < 2) return lane / RayLab::kWidth == 3 ? 99 : 30;
                   return column(lane) < 6 ? 40 : 99;
                 }},
                kPlace, run_wrong);
}

TEST_CASE(
    "a hit record outside of the table says how its number came about, and calls nothing when let pass") {
  check_mistake(
      {trace("top", "0u", "id.y == 1u ? 3u : 0u"),
       "needs hit record 4 (instance 0's 0 + geometry 1 x stride 1 + offset 3), and the binding table has 4",
       FaultKind::Record,
       2,
       {3, 1, 0},
       [](uint32_t lane) -> uint32_t {
         if (column(lane) < 2) return 30;
         if (column(lane) >= 6) return 99;
         return lane / RayLab::kWidth == 1 && column(lane) % 2 == 1 ? 99 : 40;
       }},
      kPlace, run_wrong);
}

TEST_CASE("a callable outside of the table is named, and is not called when let pass") {
  check_mistake({"executeCallableEXT(id.x == 2u ? 7u : 0u, 1); got = data;",
                 "needs callable record 7, and the binding table has 1",
                 FaultKind::Record,
                 6,
                 {2, 0, 0},
                 [](uint32_t lane) { return column(lane) == 2 ? 98 : 60; }},
                kPlace, run_wrong);
}

TEST_CASE("a trace into what is not a structure names what lies there, and misses when let pass") {
  check_mistake(
      {trace("accelerationStructureEXT(uint64_t(8u))", "0u", "0u"),
       "traces a ray into 0x8, which is not a top-level acceleration structure: a null pointer plus 8 bytes",
       FaultKind::Structure,
       36,
       {0, 0, 0},
       [](uint32_t lane) { return column(lane) < 6 ? 30 : 99; }},
      kPlace, run_wrong);
}

TEST_CASE("a ray that is not a number misses and is not a fault") {
  for (const bool timing : {false, true}) {
    exec::FaultLog faults;
    const auto results =
        run_wrong("traceRayEXT(top, 0, 0xff, 0u, 1u, 0u, origin / 0.0 * 0.0, 0.0, down, 100.0, 0);",
                  fault_options(timing), faults);
    CHECK(results == std::vector<uint32_t>(RayLab::kLanesUsed, 30));
  }
}

TEST_CASE("traces deeper than the pipeline allows stop the run also when faults are let pass") {
  for (const bool timing : {false, true}) {
    const std::string message = fault_of(trace("top", "0u", "0u"), fault_options(timing, exec::OnFault::Warn),
                                         [](const auto& code, const auto& options, auto& faults) {
                                           return run_with("faults/again.rchit", code, options, faults);
                                         });
    CHECK_THAT(message, Contains("glsl/faults/again.rchit:7 (instruction ") &&
                            Contains("traces a ray at depth 2, and the pipeline allows 1 nested traces") &&
                            Contains("launch id (2, 0, 0)"));
  }
}

}  // namespace glint::test::rays_test
