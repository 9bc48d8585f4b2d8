// Tests the timing machine on several threads: the bytes and numbers are the same, whoever runs which cell.
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstring>
#include <fmt/format.h>

#include "pipeline/scene_world.h"
#include "pipeline/timing_machine.h"
#include "tests/support/catch.h"
#include "tests/support/small_jobs.h"
#include "tests/support/stat_listing.h"
#include "tests/unit/exec/text_launch.h"

using namespace glint;
using pipeline::HostOptions;

namespace {

// Returns ways to run a machine of 8 cores and 4 partitions, all except the plainest one.
std::vector<HostOptions> ways() {
  const std::vector<uint32_t> shuffled{5, 2, 7, 0, 1, 6, 3, 4, 2, 0, 1, 3},
      crowded{0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1};
  return {{.threads = 2},
          {.threads = 4},
          {.threads = 8},
          {.threads = 0},
          {.threads = 1, .window = 1},
          {.threads = 2, .window = 7, .homes = shuffled},
          {.threads = 4, .window = 48, .homes = crowded},
          {.threads = 8, .window = 5, .homes = shuffled}};
}

std::string name_of(const HostOptions& way) {
  return fmt::format("{} threads, window {}, {} homes", way.threads, way.window, way.homes.size());
}

pipeline::GpuParams eight_cores() {
  pipeline::GpuParams params = test::preset("mobile");
  params.core.launch_latency = 0;
  return params;
}

struct Outcome {
  Cycle cycles = 0;
  std::string statistics;
  std::vector<uint32_t> memory;  // or a picture's bits
};

Outcome run_kernel(const std::string& text, const exec::TextLaunch::Options& options, const HostOptions& host,
                   const pipeline::GpuParams& params = eight_cores(), bool no_skip = false) {
  exec::TextLaunch launch(text, options);
  pipeline::TimingMachine machine(params, launch.world, no_skip, host);
  Outcome outcome;
  outcome.cycles = machine.run({});
  outcome.statistics = test::listing(machine.root());
  outcome.memory = launch.words(0, launch.num_words);
  return outcome;
}

Outcome run_frame(const pipeline::RenderJob& job, const HostOptions& host) {
  pipeline::SceneWorld scene(job);
  pipeline::TimingMachine machine(job.gpu, scene.world, false, host);
  Outcome outcome;
  outcome.cycles = machine.run({});
  outcome.statistics = test::listing(machine.root());
  for (const auto image : {pipeline::SceneWorld::kPicture, pipeline::SceneWorld::kAccumulation})
    for (const float value : scene.read_image(image))
      outcome.memory.push_back(std::bit_cast<uint32_t>(value));
  return outcome;
}

void check_equal(const Outcome& a, const Outcome& b) {
  CHECK(a.cycles == b.cycles);
  CHECK(test::first_difference(a.statistics, b.statistics) == "");
  CHECK((a.memory == b.memory));
}

// In every thread, loads, stores, exchanges and adds race with those of all others and mix what they read
// into what they write, so that any other order shows. Words 64 to 67 count adds of 1.
const std::string kRaces = R"(
    ld.param.b64 %rd2, [0];
    mad.lo.u32 %r4, %ctaid.x, %ntid.x, %tid.x;
    mov.b32 %r5, 0;
    mov.b32 %r6, %r4;
LOOP:
    mad.lo.u32 %r7, %r6, 7, %r5;
    and.b32 %r7, %r7, 63;
    mad.wide.u32 %rd8, %r7, 4, %rd2;
    ld.global.b32 %r10, [%rd8];
    mad.lo.u32 %r6, %r10, 1664525, %r6;
    st.global.b32 [%rd8 + 512], %r6;
    atom.global.add.u32 %r11, [%rd8], %r6;
    ld.global.b32 %r12, [%rd8];
    add.u32 %r6, %r6, %r11;
    xor.b32 %r6, %r6, %r12;
    atom.global.exch.b32 %r13, [%rd8 + 1024], %r6;
    add.u32 %r6, %r6, %r13;
    and.b32 %r7, %r5, 3;
    mad.wide.u32 %rd8, %r7, 4, %rd2;
    red.global.add.u32 [%rd8 + 256], 1;
    ld.global.b32 %r12, [%rd8 + 256];
    add.u32 %r6, %r6, %r12;
    add.u32 %r5, %r5, 1;
    setp.lt.u32 %p1, %r5, 12;
    @%p1 bra LOOP;
    mad.wide.u32 %rd8, %r4, 4, %rd2;
    st.global.b32 [%rd8 + 2048], %r6;
    exit;
)";
const exec::TextLaunch::Options kRacesGrid{
    .grid = {24, 1, 1}, .block = {64, 1, 1}, .buffer_words = 512 + 24 * 64};

// In a ticket lock, the first thread of each block adds 1 to word 2 and to word 40, which only the lock
// protects.
const std::string kLock = R"(
    setp.ne.u32 %p1, %tid.x, 0;
    @%p1 exit;
    ld.param.b64 %rd2, [0];
    atom.global.add.u32 %r4, [%rd2], 1;
WAIT:
    ld.global.b32 %r5, [%rd2 + 4];
    setp.ne.u32 %p2, %r5, %r4;
    @%p2 bra WAIT;
    membar.gl;
    ld.global.b32 %r6, [%rd2 + 8];
    ld.global.b32 %r7, [%rd2 + 160];
    add.u32 %r6, %r6, 1;
    add.u32 %r7, %r7, 1;
    st.global.b32 [%rd2 + 8], %r6;
    st.global.b32 [%rd2 + 160], %r7;
    membar.gl;
    add.u32 %r4, %r4, 1;
    st.global.b32 [%rd2 + 4], %r4;
    exit;
)";

// Two blocks, one per core, each store to their word and read the other's word behind a fence, in 40 places.
// Each counts in word 1000 + block how often it has read 0.
const std::string kEachOther = R"(
    ld.param.b64 %rd2, [0];
    mov.b32 %r4, %ctaid.x;
    mov.b32 %r5, 0;
    mov.b32 %r6, 0;
    mov.b32 %r13, 1;
    sub.u32 %r7, 1, %r4;
LOOP:
    mad.lo.u32 %r8, %r5, 2, %r4;
    mad.wide.u32 %rd10, %r8, 4, %rd2;
    mad.lo.u32 %r8, %r5, 2, %r7;
    mad.wide.u32 %rd14, %r8, 4, %rd2;
    st.global.b32 [%rd10], %r13;
    membar.gl;
    ld.global.b32 %r9, [%rd14];
    mad.wide.u32 %rd10, %r5, 8, %rd2;
    mad.wide.u32 %rd10, %r4, 4, %rd10;
    st.global.b32 [%rd10 + 400], %r9;
    add.u32 %r5, %r5, 1;
    setp.lt.u32 %p1, %r5, 40;
    @%p1 bra LOOP;
    exit;
)";

}  // namespace

TEST_CASE("a path-traced frame has the same bytes, cycles and statistics on any number of threads") {
  pipeline::RenderJob job = test::small_job("WKND", pipeline::Workload::PathTracing, 32, 1);
  job.gpu = eight_cores();
  const Outcome expected = run_frame(job, {});
  for (const HostOptions& way : ways()) {
    INFO(name_of(way));
    check_equal(run_frame(job, way), expected);
  }
}

TEST_CASE("racing loads, stores and atomics come out the same on any number of threads") {
  const Outcome expected = run_kernel(kRaces, kRacesGrid, {});
  for (const HostOptions& way : ways()) {
    INFO(name_of(way));
    check_equal(run_kernel(kRaces, kRacesGrid, way), expected);
  }
  for (uint32_t word = 64; word < 68; ++word) CHECK(expected.memory[word] == 24 * 64 * 3);
}

TEST_CASE("races come out the same whether idle time is skipped or not") {
  check_equal(run_kernel(kRaces, kRacesGrid, {}),
              run_kernel(kRaces, kRacesGrid, {.threads = 2}, eight_cores(), true));
}

TEST_CASE("a lock between cores keeps them apart, and what it protects is seen by the next") {
  const exec::TextLaunch::Options grid{.grid = {40, 1, 1}, .block = {32, 1, 1}};
  const Outcome expected = run_kernel(kLock, grid, {});
  CHECK(expected.memory[2] == 40);
  CHECK(expected.memory[40] == 40);
  for (const HostOptions& way : ways()) {
    INFO(name_of(way));
    check_equal(run_kernel(kLock, grid, way), expected);
  }
}

TEST_CASE(
    "of two cores that store and then read each other's word behind a fence, one at least reads the store") {
  pipeline::GpuParams params = eight_cores();
  params.core.fence.gpu = GENERATE(1, 289);
  const Outcome outcome = run_kernel(kEachOther, {.grid = {2, 1, 1}, .block = {32, 1, 1}}, {}, params);
  for (uint32_t round = 0; round < 40; ++round) {
    CAPTURE(round);
    CHECK(outcome.memory[100 + 2 * round] + outcome.memory[101 + 2 * round] > 0);
  }
}

TEST_CASE("a thread reads what its own atomic has made, on one core and on many") {
  const std::string text =
      "    ld.param.b64 %rd2, [0];\n    mov.b32 %r4, 7;\n    st.global.b32 [%rd2], %r4;\n"
      "    ld.global.b32 %r5, [%rd2];\n"  // the line is in the L1 from here on
      "    red.global.add.u32 [%rd2], %r5;\n    ld.global.b32 %r6, [%rd2];\n    add.u32 %r6, %r6, 1;\n"
      "    st.global.b32 [%rd2 + 4], %r6;\n    exit;\n";
  pipeline::GpuParams params = eight_cores();
  params.cores = GENERATE(1u, 8u);
  const Outcome outcome =
      run_kernel("    setp.ne.u32 %p1, %tid.x, 0;\n    @%p1 exit;\n" + text, {.grid = {1, 1, 1}}, {}, params);

  CHECK(outcome.memory[0] == 14);
  CHECK(outcome.memory[1] == 15);
}

TEST_CASE("a fault is the same one on any number of threads") {
  const std::string text =
      "    ld.param.b64 %rd2, [0];\n    mad.wide.u32 %rd2, %ctaid.x, 65536, %rd2;\n    ld.global.b32 %r4, "
      "[%rd2];\n    exit;\n";
  const auto fault = [&](const HostOptions& host) -> std::string {
    try {
      run_kernel(text, {.grid = {40, 1, 1}}, host);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const std::string expected = fault({});
  CHECK(expected.find("reads 4 bytes") != std::string::npos);
  for (const HostOptions& way : ways()) CHECK(fault(way) == expected);
}
