// Declares `glint run FILE.toml` and `glint run SHADER`, which launch a described pipeline.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "apps/glint/run/launch_options.h"
#include "apps/glint/session.h"
#include "pipeline/description/description.h"

namespace glint::app {

// Returns whether `what` is a shader file, or a TOML file that does not launch a kernel.
bool names_pipeline(const std::string& what);
// Reads the file, or describes the pipeline of a shader file with its companions by defaults. The options win
// over the file's.
pipeline::PipelineDescription read_description(const std::string& what, const frontend::GlslOptions& glsl);
// Runs the pipeline. The command line's options win over the file's.
Exit run_pipeline(const Session& session, const std::string& what, const LaunchOptions& options);

}  // namespace glint::app
