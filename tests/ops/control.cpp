// Checks control ops, barriers, fences and prints by what their programs leave on both machines.
// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "pipeline/timing_machine.h"
#include "tests/ops/control_cases.h"
#include "tests/ops/oracle.h"
#include "tests/support/catch.h"
#include "tests/unit/exec/text_launch.h"

namespace glint::test {
namespace {

// The words of the threads lie at the beginning of the buffer, and what lanes exchange behind them.
constexpr uint32_t kExchanged = 512;

std::string program_of(const ControlCase& test) {
  return test.header + R"(
    mov.b32 %r4, %tid.x;
    ld.param.b64 %rd2, [0];
    add.u64 %rd24, %rd2, 2048;
    mad.wide.u32 %rd22, %r4, 8, %rd2;
)" + test.text +
         R"(
    st.global.b32 [%rd22], %r20;
    st.global.b32 [%rd22 + 4], %r21;
    exit;
)" + test.functions;
}

struct Ran {
  uint64_t lanes = 0;
  std::string fault, printed;
  std::vector<uint32_t> words;
};
Ran run_case(const ControlCase& test, const isa::OpRow& row, bool timing) {
  exec::TextLaunch launch(program_of(test), {.block = {test.threads, 1, 1},
                                             .shared_bytes = 1024,
                                             .local_bytes = test.called.empty() ? 0u : 16u,
                                             .functions = test.called,
                                             .stack_bytes = test.called.empty() ? 0u : 4096u});
  Ran out;
  exec::PrintLog log;
  launch.world.prints = &log;
  const auto listen = [&](const exec::Retired& retired) {
    if (retired.issued.row == &row) out.lanes += uint64_t(std::popcount(retired.issued.lanes));
  };
  try {
    if (timing) {
      pipeline::GpuParams gpu;
      gpu.cores = 2;
      pipeline::TimingMachine machine(gpu, launch.world, false);
      for (uint32_t c = 0; c < machine.num_cores(); ++c) machine.core(c).executor().retired.listen(listen);
      machine.run({});
    } else {
      pipeline::run_functional(launch.world, 1'000'000, {}, listen);
    }
  } catch (const Error& error) {
    out.fault = error.what();
  }
  out.printed = log.take();
  out.words = launch.words(0, kExchanged);
  return out;
}

uint64_t check_case(const ControlCase& test, const isa::OpRow& row, bool timing) {
  INFO((timing ? "timing" : "functional") << " machine");
  const Ran ran = run_case(test, row, timing);
  if (!test.fault.empty()) {
    CHECK(ran.fault.find(test.fault) != std::string::npos);
    return 1;  // An op that ends the run does not retire.
  }
  CHECK(ran.fault == "");
  CHECK(ran.printed == test.printed);
  std::vector<uint32_t> expected(kExchanged);
  for (uint32_t t = 0; t < test.threads; ++t) {
    const ControlWords words = test.expected(t);
    for (size_t w = 0; w < kControlWords; ++w) expected[t * kControlWords + w] = words[w];
  }
  CHECK(ran.words == expected);
  return ran.lanes;
}

}  // namespace

uint64_t check_control(const isa::OpRow& row) {
  uint64_t lanes = 0;
  for (const ControlCase& test : control_cases())
    if (test.op == row.name)
      for (const bool timing : {false, true}) lanes += check_case(test, row, timing);
  return lanes;
}

}  // namespace glint::test
