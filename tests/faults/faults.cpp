// Runs a mistake on both machines, stopping and going on.
// SPDX-License-Identifier: Apache-2.0
#include "tests/faults/faults.h"

#include <cstdint>
#include <fmt/format.h>

#include "base/diagnostics.h"
#include "tests/support/catch.h"

namespace glint::test {

using Catch::Contains;

LabOptions fault_options(bool timing, exec::OnFault on_fault) {
  LabOptions options;
  options.timing = timing;
  options.on_fault = on_fault;
  return options;
}

std::string fault_of(const std::string& code, const LabOptions& options, const RunWrong& run) {
  try {
    exec::FaultLog faults;
    run(code, options, faults);
  } catch (const Error& error) {
    CHECK(error.exit() == Exit::Fault);
    return error.what();
  }
  return "";
}

void check_mistake(const Mistake& mistake, const std::string& place, const RunWrong& run) {
  std::string told[2];
  for (const bool timing : {false, true}) {
    CAPTURE(mistake.code, timing);
    const std::string message = fault_of(mistake.code, fault_options(timing), run);
    CHECK_THAT(message, Contains(place + " (instruction ") && Contains("fault: ") && Contains(mistake.what));
    const auto& [x, y, z] = mistake.first;
    CHECK_THAT(message, Contains(fmt::format("launch id ({}, {}, {})", x, y, z)));

    exec::FaultLog faults;
    const std::vector<uint32_t> results =
        run(mistake.code, fault_options(timing, exec::OnFault::Warn), faults);
    for (uint32_t lane = 0; lane < results.size(); ++lane) {
      CAPTURE(lane);
      CHECK(results[lane] == mistake.result(lane));
    }
    const std::vector<exec::FaultLog::Entry> all = faults.in_order();
    REQUIRE(!all.empty());
    CHECK(all[0].kind == mistake.kind);
    CHECK(all[0].count == mistake.count);
    CHECK(all[0].first.launch_id == mistake.first);
    CHECK_THAT(all[0].first.place, Contains(place + " (instruction "));
    CHECK_THAT(all[0].first.what, Contains(mistake.what));
    told[timing] = faults.to_string();
  }
  CHECK(told[0] == told[1]);
}

}  // namespace glint::test
