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
  std::string by = "position";  // how blocks are chosen, by the name of a pipeline::SampleWay
  bool seed_given = false, by_given = false;

  bool wants_pixels() const { return !share.empty(); }
  bool wants_launches() const { return !launches.empty(); }
  // Returns the option that was given, or "".
  std::string given() const;
  // Returns what was asked for. Throws UserError when the share is none.
  pipeline::SampleOptions options() const;
  // Returns how many of so many launches were asked for. Throws UserError when that is all of them or more,
  // or fewer than `least`, and when the text is neither a number nor a share.
  uint32_t launches_of(uint32_t all, uint32_t least) const;
  // Notes which options the command line named. It is called after parsing.
  void note_given(const Command& command);
};

// Adds --sample-pixels, --sample-launches, --sample-by and --sample-seed.
void add_sample_options(Command command, SampleChoice& choice);

// Throws UserError when the options of a sample have another form, or name what nothing is sampled by.
void check_sample_forms(const SampleChoice& choice);

// Throws UserError when they do, or when they do not go together in one run.
void check_sample_options(const SampleChoice& choice);

}  // namespace glint::app
