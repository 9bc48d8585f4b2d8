// Declares the options of a sampled run.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/glint/options/command_line.h"
#include "pipeline/sampling/sample_plan.h"

namespace glint::app {

struct SampleChoice {
  std::string share;  // "5%"; empty: the whole launch is run
  uint64_t seed = 1;

  bool wanted() const { return !share.empty(); }
  // Returns what was asked for. Throws UserError when the share is none.
  pipeline::SampleOptions options() const;
};

// Adds --sample-pixels and --sample-seed.
void add_sample_options(Command command, SampleChoice& choice);

}  // namespace glint::app
