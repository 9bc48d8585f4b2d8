// Tests the recorded conformance set with rays walked in code against the shared traversal, bit for bit.
// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <iostream>

#include "tests/support/catch.h"
#include "tests/vulkan_rt/compare.h"
#include "tests/vulkan_rt/conformance_world.h"

namespace glint::vulkan_rt {
namespace {

TEST_CASE(
    "the traversal program gives every ray of every mode the record that the shared traversal gives it") {
  if (!has_recording()) {
    std::cout << "SKIPPED: no recording in " << recording_folder()
              << "; GLINT_VULKAN_RT_DIR names another folder\n";
    return;
  }
  const Recording& r = recording();
  uint64_t rays = 0;
  for (const Mode& mode : r.modes) {
    const std::vector<Record> unit = run_mode(r, mode, "immediate"),
                              code = run_mode(r, mode, "immediate", false, "bvh6", true);
    uint32_t differ = 0;
    for (size_t i = 0; i < unit.size(); ++i) differ += std::memcmp(&unit[i], &code[i], sizeof unit[i]) != 0;
    INFO(mode.name << ": " << differ << " of " << unit.size() << " differ");
    CHECK(differ == 0);
    rays += unit.size();
  }
  std::cout << "software       " << rays << " rays in " << r.modes.size() << " modes, every record equal\n";
  CHECK(rays > 0);
}

}  // namespace
}  // namespace glint::vulkan_rt
