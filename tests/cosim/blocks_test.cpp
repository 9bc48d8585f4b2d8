// Tests blocks on both machines: race-free programs leave the same memory, and time behaves.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/timing_machine.h"
#include "tests/support/catch.h"
#include "tests/unit/exec/text_launch.h"

using namespace glint;

namespace {

pipeline::GpuParams small_gpu() {
  pipeline::GpuParams params;
  params.cores = 3;
  params.core.launch_latency = 0;
  return params;
}

Cycle run_timing(exec::TextLaunch& launch, bool no_skip = false,
                 const pipeline::GpuParams& params = small_gpu()) {
  pipeline::TimingMachine machine(params, launch.world, no_skip);
  const Cycle cycles = machine.run({});
  for (uint32_t i = 0; i < machine.num_cores(); ++i)
    CHECK(machine.core(i).stats().stalls.total() == machine.attributed_cycles() * params.core.schedulers);
  return cycles;
}

// Sums 0 to 255 of each block in shared memory. The block's result goes to its word, and into a global sum at
// word 0.
const std::string kReduce = R"(
    mov.b32 %r4, %tid.x;
    shl.b32 %r5, %r4, 2;
    st.shared.b32 [%r5], %r4;
    mov.b32 %r6, %ntid.x;
    shr.u32 %r6, %r6, 1;
    bar.sync 0, 0;
LOOP:
    ssy MEET;
    setp.ge.u32 %p1, %r4, %r6;
    @%p1 bra MEET;
    add.u32 %r7, %r4, %r6;
    shl.b32 %r7, %r7, 2;
    ld.shared.b32 %r8, [%r7];
    ld.shared.b32 %r9, [%r5];
    add.u32 %r9, %r9, %r8;
    st.shared.b32 [%r5], %r9;
MEET:
    join;
    bar.sync 0, 0;
    shr.u32 %r6, %r6, 1;
    setp.ne.u32 %p2, %r6, 0;
    @%p2 bra LOOP;
    setp.ne.u32 %p3, %r4, 0;
    @%p3 exit;
    ld.shared.b32 %r10, [0];
    ld.param.b64 %rd12, [0];
    red.global.add.u32 [%rd12], %r10;
    mov.b32 %r14, %ctaid.x;
    mad.wide.u32 %rd12, %r14, 4, %rd12;
    st.global.b32 [%rd12 + 4], %r10;
    exit;
)";

// Counts the residues of the thread numbers modulo 16, first in shared memory, then for all blocks in global
// memory. The old values of a second atomic add up to the same whatever the order.
const std::string kHistogram = R"(
    mad.lo.u32 %r4, %ctaid.x, %ntid.x, %tid.x;
    rem.u32 %r5, %r4, 16;
    shl.b32 %r5, %r5, 2;
    red.shared.add.u32 [%r5], 1;
    bar.sync 0, 0;
    ld.param.b64 %rd2, [0];
    atom.global.add.u32 %r6, [%rd2 + 128], 1;
    red.global.add.u32 [%rd2 + 132], %r6;
    setp.ge.u32 %p1, %tid.x, 16;
    @%p1 exit;
    shl.b32 %r7, %tid.x, 2;
    ld.shared.b32 %r8, [%r7];
    mad.wide.u32 %rd2, %tid.x, 4, %rd2;
    atom.global.add.u32 %r9, [%rd2], %r8;
    exit;
)";

struct Kernel {
  const char* name;
  std::string text;
  exec::TextLaunch::Options options;
};
std::vector<Kernel> kernels() {
  return {{"reduce", kReduce, {.grid = {20, 1, 1}, .block = {256, 1, 1}, .shared_bytes = 1024}},
          {"histogram", kHistogram, {.grid = {13, 1, 1}, .block = {96, 1, 1}, .shared_bytes = 64}}};
}

}  // namespace

TEST_CASE("race-free blocks leave the same memory on both machines") {
  for (const Kernel& kernel : kernels()) {
    CAPTURE(kernel.name);
    exec::TextLaunch functional(kernel.text, kernel.options), timing(kernel.text, kernel.options);
    functional.run();
    run_timing(timing);

    CHECK(functional.words(0, 1024) == timing.words(0, 1024));
    CHECK(functional.words(0, 1024) != std::vector<uint32_t>(1024, 0));
  }
}

TEST_CASE("blocks take the same cycles whether idle time is skipped or not") {
  for (const Kernel& kernel : kernels()) {
    CAPTURE(kernel.name);
    exec::TextLaunch skipping(kernel.text, kernel.options), stepping(kernel.text, kernel.options);

    CHECK(run_timing(skipping, false) == run_timing(stepping, true));
  }
}

TEST_CASE("parts of warps that come to a barrier one after another leave the same memory when let pass") {
  const std::string text = R"(
    mov.b32 %r4, %tid.x;
    and.b32 %r5, %r4, 31;
    setp.ge.u32 %p1, %r5, 16;
    ssy DONE;
    @%p1 bra OTHER;
    bar.sync 0, 0;
    bra DONE;
OTHER:
    bar.sync 0, 0;
DONE:
    join;
    ld.param.b64 %rd2, [0];
    mad.wide.u32 %rd2, %r4, 4, %rd2;
    st.global.b32 [%rd2], %r4;
    exit;
)";
  exec::TextLaunch functional(text, {.block = {96, 1, 1}}), timed(text, {.block = {96, 1, 1}});
  functional.world.on_fault = timed.world.on_fault = exec::OnFault::Warn;
  functional.run();
  run_timing(timed);

  for (uint32_t i = 0; i < 96; ++i) {
    CHECK(functional.word(i) == i);
    CHECK(timed.word(i) == i);
  }
}

TEST_CASE("an atomic costs a trip to the L2, and a red does not") {
  const auto cycles = [](const std::string& op) {
    std::string text = "    ld.param.b64 %rd2, [0];\n    mov.b32 %r4, 1;\n";
    for (int i = 0; i < 8; ++i) text += "    " + op + "\n";
    exec::TextLaunch launch(text + "    exit;\n", {});
    return run_timing(launch);
  };
  // This is a chain: each atomic adds what the one before returned.
  const Cycle chain = cycles("atom.global.add.u32 %r4, [%rd2], %r4;"),
              apart = cycles("red.global.add.u32 [%rd2], 1;");

  CHECK(chain > 8 * 2 * 48);  // eight round trips over the network
  CHECK(apart < chain / 2);
}

TEST_CASE("the L2 counts atomics, and they leave the line dirty") {
  exec::TextLaunch launch("    ld.param.b64 %rd2, [0];\n    atom.global.add.u32 %r4, [%rd2], 1;\n    exit;\n",
                          {});
  pipeline::TimingMachine machine(small_gpu(), launch.world, false);
  machine.run({});

  uint64_t atomics = 0;
  for (uint32_t p = 0; p < machine.memory().num_partitions(); ++p)
    atomics += machine.memory().partition(p).stats().reads.count(mem::Traffic::ShaderAtomic);
  CHECK(atomics == 1);
  CHECK(launch.word(0) == 32);
}

TEST_CASE("programs read the clock and their place on the timing machine") {
  exec::TextLaunch launch(R"(
    mov.b32 %r4, %clock;
    mov.b32 %r5, %globaltimer_lo;
    mov.b32 %r6, %smid;
    mov.b32 %r7, %nsmid;
    ld.param.b64 %rd2, [0];
    mad.wide.u32 %rd2, %ctaid.x, 16, %rd2;
    st.global.v4.b32 [%rd2], {%r4, %r5, %r6, %r7};
    exit;
)",
                          {.grid = {3, 1, 1}, .block = {512, 1, 1}});
  pipeline::GpuParams params = small_gpu();
  params.clock_mhz = 500.0;
  params.core.launch_latency = 1000;
  params.core.warps = 16;  // a block fills a core
  run_timing(launch, false, params);

  for (uint32_t block = 0; block < 3; ++block) {
    const std::vector<uint32_t> words = launch.words(block * 4, 4);
    CHECK(words[0] >= 1000);
    CHECK(words[1] >= 2000);  // nanoseconds of 500 MHz
    CHECK(words[2] == block);
    CHECK(words[3] == 3);
  }
}

TEST_CASE("a barrier that nobody can complete ends the timing machine with the same fault") {
  const std::string text =
      "    setp.ge.u32 %p1, %tid.x, 96;\n    @%p1 exit;\n    bar.sync 2, 256;\n    exit;\n";
  exec::TextLaunch launch(text, {.block = {256, 1, 1}}), functional(text, {.block = {256, 1, 1}});
  std::string message;
  try {
    run_timing(launch);
  } catch (const Error& error) {
    message = error.what();
  }
  CHECK(message.find("3 of 8 warps wait at bar.sync 2") != std::string::npos);
  CHECK(message == functional.fault());
}
