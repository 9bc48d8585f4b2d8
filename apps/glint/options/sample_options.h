// Declares the options of a sampled run.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "apps/glint/options/command_line.h"
#include "pipeline/sampling/sample_plan.h"

namespace glint::app {

struct SampleChoice {
  std::string share;     // of pixels, "5%"; empty: the whole launch is run
  std::string launches;  // "20" or "5%"; empty: all launches are timed
  uint64_t seed = 1;
  bool seed_given = false;

  bool wants_pixels() const { return !share.empty(); }
  bool wants_launches() const { return !launches.empty(); }
  // Returns the option that was given, or "".
  std::string given() const;
  // Returns what was asked for. Throws UserError when the share is none.
  pipeline::SampleOptions options() const;
  // Returns how many of so many launches were asked for. Throws UserError when that is all of them or more,
  // or fewer than `least`, and when the text is neither a number nor a share.
  uint32_t launches_of(uint32_t all, uint32_t least) const;
};

// Adds --sample-pixels, --sample-launches and --sample-seed.
void add_sample_options(Command command, SampleChoice& choice);

// Throws UserError when the options of a sample do not go together or have another form.
void check_sample_options(const SampleChoice& choice);

}  // namespace glint::app
