// Runs whole scripts on both machines.
// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <functional>
#include <vector>

#include "tests/amber/support.h"
#include "tests/support/catch.h"

namespace glint::amber {
namespace {

Outcome run(const std::string& name, bool timing) {
  LaunchOptions options;
  options.mode.timing = timing;
  return run_script(std::string(GLINT_SOURCE_DIR) + "/tests/amber/scripts/" + name + ".amber", options);
}

TEST_CASE("scripts of every kind pass on the functional machine", "[amber]") {
  for (const char* name :
       {"values",         "shared",    "spirv",       "layouts",       "images",  "rays",     "options",
        "reported_again", "resources", "entries",     "numbers",       "files",   "sections", "versions",
        "first_hit",      "strides",   "far_binding", "chosen_arrays", "samples", "robust",   "clamped"}) {
    const Outcome outcome = run(name, false);
    INFO(name << ": " << outcome.message);
    CHECK(outcome.verdict == Verdict::Passed);
    CHECK(outcome.launches >= 1);
    CHECK(outcome.expectations >= 1);
    CHECK(outcome.cycles == 0);
  }
}

TEST_CASE("a script passes on the timing machine and takes time there", "[amber]") {
  for (const char* name : {"shared", "rays", "robust"}) {
    const Outcome outcome = run(name, true);
    INFO(name << ": " << outcome.message);
    CHECK(outcome.verdict == Verdict::Passed);
    CHECK(outcome.cycles > 100);
  }
}

TEST_CASE("REPEAT runs its commands as often as it says", "[amber]") {
  const Outcome outcome = run("shared", false);
  CHECK(outcome.launches == 5);
}

// Sums buffer a into each element of b, three times, with host commands between the launches.
constexpr const char* kThreeLaunches = R"(
SHADER compute sum GLSL
#version 450
layout(local_size_x = 4) in;
layout(binding = 0) buffer A { uint a[]; };
layout(binding = 1) buffer B { uint b[]; };
void main() { for (uint i = 0; i < a.length(); ++i) b[gl_GlobalInvocationID.x] += a[i]; }
END
BUFFER a DATA_TYPE uint32 DATA 1 2 END
BUFFER longer DATA_TYPE uint32 DATA 10 20 30 40 END
BUFFER b DATA_TYPE uint32 SIZE 4 FILL 0
PIPELINE compute p
  ATTACH sum
  BIND BUFFER a AS storage DESCRIPTOR_SET 0 BINDING 0
  BIND BUFFER b AS storage DESCRIPTOR_SET 0 BINDING 1
END
RUN p 1 1 1
EXPECT b IDX 0 EQ 3 3 3 3
RUN p 1 1 1
EXPECT b IDX 0 EQ 6 6 6 6
COPY longer TO a
RUN p 1 1 1
EXPECT b IDX 0 EQ 106 106 106 106
)";

TEST_CASE("the launches of a script share one memory, and buffers keep their addresses", "[amber]") {
  LaunchOptions options;
  std::vector<const void*> memories;
  std::vector<uint64_t> in_use;
  std::vector<Address> places;  // of buffer b
  options.record = [&](const ScriptLaunch& launch, const std::function<pipeline::RenderResult()>& run) {
    CHECK(launch.number == memories.size());
    CHECK(launch.pipeline == "p");
    CHECK(launch.shaders == "sum");
    memories.push_back(launch.world.memory);
    in_use.push_back(launch.world.memory->bytes_in_use());
    for (Address slot = 1; slot < launch.world.memory->slots().size(); ++slot)
      if (launch.world.memory->describe(slot << mem::AddressSpace::kShift).find("'b'") != std::string::npos)
        places.push_back(slot);
    run();
  };
  const Outcome outcome = outcome_of(kThreeLaunches, options);
  INFO(outcome.message);
  CHECK(outcome.verdict == Verdict::Passed);
  REQUIRE(memories.size() == 3);
  CHECK(memories[1] == memories[0]);
  CHECK(memories[2] == memories[0]);
  CHECK(in_use[1] == in_use[0]);  // What a launch alone needs is given back.
  CHECK(places == std::vector<Address>(3, places.at(0)));
}

TEST_CASE("cold launches of a script have the cycles of the first, and warm ones fewer", "[amber]") {
  for (const pipeline::Caches caches : {pipeline::Caches::Cold, pipeline::Caches::Warm}) {
    LaunchOptions options;
    options.mode.timing = true, options.mode.caches = caches;
    std::vector<uint64_t> cycles;
    options.record = [&](const ScriptLaunch&, const std::function<pipeline::RenderResult()>& run) {
      cycles.push_back(run().cycles);
    };
    const Outcome outcome = outcome_of(kThreeLaunches, options);
    CHECK(outcome.verdict == Verdict::Passed);
    REQUIRE(cycles.size() == 3);
    CHECK(outcome.cycles == cycles[0] + cycles[1] + cycles[2]);
    if (caches == pipeline::Caches::Cold)
      CHECK(cycles[1] == cycles[0]);
    else
      CHECK(cycles[1] < cycles[0]);
  }
}

TEST_CASE("a launch that is ended early ends its script", "[amber]") {
  LaunchOptions options;
  options.mode.timing = true;
  options.watch.max_cycles = 100;
  const Outcome outcome = outcome_of(kThreeLaunches, options);
  CHECK(outcome.verdict == Verdict::Failed);
  CHECK(outcome.launches == 1);
  CHECK(contains(outcome.message, "t.amber:18: the launch was ended early"));
}

TEST_CASE("a script that is not there fails as bad input", "[amber]") {
  const Outcome outcome = run("no_such_script", false);
  CHECK(outcome.verdict == Verdict::Failed);
  CHECK(outcome.exit == Exit::UserInput);
  CHECK(contains(outcome.message, "cannot read"));
}

}  // namespace
}  // namespace glint::amber
