// Tests the compute suite: every program on both machines, and that a wrong value is noticed.
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "compute/host.h"
#include "tests/support/catch.h"
#include "tests/support/preset.h"

using namespace glint;

namespace {

compute::HostSetup setup_of(bool timing) {
  compute::HostSetup out;
  out.gpu = test::preset("mobile");
  out.kernels = GLINT_SOURCE_DIR "/shaders/compute";
  out.mode.timing = timing;
  return out;
}

void write_wrong(compute::Host& host, compute::Size) {
  const auto values = host.buffer("values", std::vector<float>{1, 2, 3});
  host.check("values", values, std::vector<float>{1, 2, 3});
  host.check("values", values, std::vector<float>{1, 2.001f, 3}, 1e-3);
  host.check("values", values, std::vector<float>{1, 2, 3.5f}, 1e-3);
}

void launch_saxpy(compute::Host& host, compute::Size) {
  host.launch("saxpy", {1, 1, 1}, {}, uint32_t{1});
}

}  // namespace

TEST_CASE("every program computes its reference's values on both machines, with the same instructions") {
  for (const compute::Program& program : compute::all_programs()) {
    INFO(program.name);
    const auto functional = compute::run_program(program, compute::Size::Small, setup_of(false)),
               timed = compute::run_program(program, compute::Size::Small, setup_of(true));
    CHECK(functional.checked > 0);
    CHECK(timed.checked == functional.checked);
    REQUIRE(timed.launches.size() == functional.launches.size());
    for (size_t i = 0; i < timed.launches.size(); ++i) {
      CHECK(timed.launches[i].lane_instructions == functional.launches[i].lane_instructions);
      CHECK(timed.launches[i].cycles > 0);
    }
  }
}

TEST_CASE("the suite has thirteen programs in GLSL, and a form in PTX is another row with the same host") {
  size_t suite = 0, ptx = 0;
  for (const compute::Program& program : compute::all_programs()) {
    INFO(program.name);
    if (program.form == compute::Form::Glsl) {
      ++suite;
      CHECK((compute::find_program(program.name + "-ptx") != nullptr) == program.has_ptx);
      continue;
    }
    ++ptx;
    const compute::Program* glsl = compute::find_program(program.name.substr(0, program.name.size() - 4));
    REQUIRE(glsl);
    CHECK(glsl->run == program.run);
    CHECK(glsl->full_input == program.full_input);
  }
  CHECK(suite == 13);
  CHECK(ptx == 6);
}

TEST_CASE("a PTX kernel that does not say how large its blocks are is refused") {
  compute::HostSetup setup = setup_of(false);
  setup.kernels = GLINT_SOURCE_DIR "/shaders/kernels";
  const compute::Program program{"saxpy", "", "", "", 1, 1, 0, launch_saxpy, true, compute::Form::Ptx};
  CHECK_THROWS_WITH(compute::run_program(program, compute::Size::Small, setup),
                    Catch::Contains("the kernel does not say how many threads its blocks have"));
}

TEST_CASE("a value that is not the reference's is told with its place and both numbers") {
  const compute::Program program{"wrong", "", "", "", 1, 1, 0, write_wrong};
  try {
    compute::run_program(program, compute::Size::Small, setup_of(false));
    FAIL("nothing was thrown");
  } catch (const compute::WrongResult& error) {
    CHECK(std::string(error.what()) == "error: value 2 of 'values' is 3, and the reference computes 3.5");
  }
}

TEST_CASE("a program whose launch is ended early checks nothing") {
  compute::HostSetup setup = setup_of(true);
  setup.watch.max_cycles = 1;
  const auto result = compute::run_program(*compute::find_program("bfs"), compute::Size::Small, setup);
  CHECK(result.checked == 0);
  CHECK(result.launches.size() == 1);
  CHECK(result.sum.end == pipeline::LaunchEnd::MaxCycles);
}
