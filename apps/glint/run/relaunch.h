// Makes the launches of a finished run anew, for models that look at what a launch does.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>

#include "apps/glint/options/shader_options.h"
#include "apps/glint/session.h"
#include "exec/image.h"
#include "pipeline/render.h"
#include "report/files/run_record.h"

namespace glint::app {

// Holds options of the run that its run.json does not have.
struct RelaunchOptions {
  std::string assets, shader_dir;
  ShaderOptions shaders;
};

// Takes each launch in turn, and runs it: what it leaves in memory, later launches find there. `warm` says
// that a launch finds the caches as the one before it has left them.
using LaunchTaker = std::function<pipeline::RenderResult(const exec::World& world, bool warm)>;

// Returns an empty text when relaunch() knows runs of this kind, and otherwise why not.
std::string why_not_relaunched(const report::RunRecord& run);

// Hands every launch of the run to `take`. Throws UserError when the run's scene, program or file is not here
// as the run found it, as far as run.json tells.
void relaunch(const Session& session, const RelaunchOptions& options, const report::RunRecord& run,
              const std::string& directory, const pipeline::GpuParams& gpu, const LaunchTaker& take);

}  // namespace glint::app
