// Tests that a trace does to memory and to the caches what its launch has done.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/sampling/launch_traces.h"

#include <string>
#include <vector>

#include "pipeline/run_stats.h"
#include "pipeline/sampling/warm_launch.h"
#include "tests/support/catch.h"
#include "tests/support/preset.h"
#include "tests/unit/exec/text_launch.h"

using namespace glint;
using namespace glint::pipeline;

namespace {

// Each thread adds 3 to a word of its own, and 1 to a word of all.
const std::string kBody = exec::kOwnWord +
                          "    ld.global.b32 %r5, [%rd2];\n"
                          "    add.s32 %r5, %r5, 3;\n"
                          "    st.global.b32 [%rd2], %r5;\n"
                          "    ld.param.b64 %rd4, [0];\n"
                          "    atom.global.add.u32 %r6, [%rd4 + 3996], 1;\n"
                          "    exit;\n";
constexpr uint32_t kWordOfAll = 999;

struct Launches {
  exec::TextLaunch launch{kBody, {.block = {256, 1, 1}, .buffer_words = 1000}};
  GpuParams gpu = test::preset("mobile");
  Device device{gpu};
  WarmCaches caches{gpu, device};

  std::vector<uint32_t> words() { return launch.words(0, 1000); }
  // Returns the cycles of a launch that finds what the device's caches hold.
  uint64_t cycles() {
    caches.give_back();
    LaunchMode mode;
    mode.caches = Caches::Warm;
    return device.run(launch.world, mode, {}).cycles;
  }
};

}  // namespace

TEST_CASE("A trace leaves the bytes and the lines of its launch", "[traces]") {
  Launches recorded, run, replayed;
  LaunchTraces traces;
  for (int i = 0; i < 2; ++i) {
    const FunctionalCounts counts = traces.record(recorded.launch.world, recorded.gpu, {});
    CHECK(counts.end == LaunchEnd::Whole);
    const RenderResult warmed = run.caches.run(run.launch.world, Caches::Warm, {});
    CHECK(counts.instructions() == warmed.warp_instructions);
    REQUIRE(traces.has(size_t(i)));
    replayed.caches.replay(traces, size_t(i), replayed.launch.world, Caches::Warm);
  }
  CHECK(recorded.launch.word(5) == 6);
  CHECK(recorded.launch.word(kWordOfAll) == 512);
  CHECK(run.words() == recorded.words());
  CHECK(replayed.words() == recorded.words());
  const uint64_t warm = run.cycles();
  CHECK(replayed.cycles() == warm);
  CHECK(recorded.cycles() > warm);  // Its device has found nothing yet.
}

TEST_CASE("A trace that has no room is not kept, and one that is dropped gives its room back", "[traces]") {
  Launches here;
  LaunchTraces none(1000), traces;
  none.record(here.launch.world, here.gpu, {});
  CHECK_FALSE(none.has(0));
  CHECK(none.bytes() == 0);
  CHECK(here.launch.word(5) == 3);  // The launch has run.
  traces.record(here.launch.world, here.gpu, {});
  CHECK(traces.bytes() > 1024);
  traces.drop(0);
  CHECK(traces.bytes() == 0);
  CHECK_FALSE(traces.has(0));
  CHECK_FALSE(traces.has(7));
}

TEST_CASE("A launch that was stopped leaves no trace", "[traces]") {
  Launches here;
  LaunchTraces traces;
  LaunchWatch watch;
  watch.stop = [] { return true; };
  CHECK(traces.record(here.launch.world, here.gpu, watch).end == LaunchEnd::Stopped);
  CHECK_FALSE(traces.has(0));
}
