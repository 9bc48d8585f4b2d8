// Runs scripts given as text and returns their outcomes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "amber/run.h"

namespace glint::amber {

inline Outcome outcome_of(const std::string& body, const LaunchOptions& options = {}) {
  Outcome out;
  try {
    out = run_script(parse_script("#!amber\n" + body, "t.amber"), options);
  } catch (const Error& error) {
    out.verdict = error.exit() == Exit::Unsupported ? Verdict::Unsupported : Verdict::Failed;
    out.exit = error.exit(), out.message = error.what();
  }
  return out;
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace glint::amber
