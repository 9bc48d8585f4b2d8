// Declares the options of a sequence of frames: which frames, how time passes, and what is kept between them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "apps/glint/options/command_line.h"
#include "pipeline/render.h"
#include "report/files/run_directory.h"
#include "scenes/motion.h"

namespace glint::app {

struct SequenceOptions {
  std::string frames;  // "A:B", or "A" for one; empty: the scene stands still
  double fps = 24;
  std::string camera_path;  // file; empty: the scene's own camera
  std::string animation;    // of a glTF file; empty: the first one
  std::string structures = "rebuild";
  std::string caches;  // "cold" or "warm"; empty: warm
  bool is_wanted() const { return !frames.empty(); }
  // Returns the first option, of those that only scenes have, that was given and has no meaning without
  // --frames, or "".
  std::string given() const;
};

inline constexpr const char* kCachesElsewhere = "--caches belongs to Amber scripts and to --frames";

// Throws UserError when options were given that have no meaning without --frames.
void check_without_frames(const SequenceOptions& options);

// Adds --frames, --fps, --camera-path, --animation and --structures.
void add_sequence_options(Command command, SequenceOptions& options);

// Returns what run.json says of a sequence. Throws UserError where the frames have another form.
report::SequenceInfo sequence_of(const SequenceOptions& options);

pipeline::StructureUpdate structure_update(const SequenceOptions& options);

// Throws UserError when a frame lies after the end of the motion, with the frames that there are.
void check_range(const report::SequenceInfo& sequence, const scenes::Motion& motion,
                 const std::string& scene);

}  // namespace glint::app
