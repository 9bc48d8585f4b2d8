// Declares `glint run SCENE`, which renders a frame of a scene, or several, on the simulated GPU.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "apps/glint/options/frame_options.h"
#include "apps/glint/options/sequence_options.h"
#include "apps/glint/run/launch_options.h"
#include "apps/glint/session.h"
#include "pipeline/render.h"
#include "pipeline/structure_cache.h"
#include "report/files/run_directory.h"

namespace glint::app {

struct SceneOptions {
  std::string scene, shader = "pt";
  std::string assets;      // folder of original scene data; empty: none
  std::string shader_dir;  // empty: the workload's own shaders
  bool instancing = false, shader_given = false;
  bool exr = false;  // also keep the picture as image.exr
  FrameOptions frame;
  SequenceOptions sequence;
  // Returns the first option that was given and has no meaning for what is not a scene, or "".
  std::string given() const;
};

// Splits the name of a workload into scene and shader set. Throws UserError for files of other kinds, and
// where both the name and --shader say a shader set.
void check_scene(SceneOptions& options);

// Loads the scene, or takes it from the store, and returns the frame that the options ask for, without a
// machine.
pipeline::RenderJob frame_job(const Session& session, const SceneOptions& options, uint32_t threads,
                              scenes::SceneStore* store = nullptr);

// Holds such a job with its machine, ready to run, and what it refers to: caches of shaders and structures,
// and what shaders print.
struct ReadySceneJob {
  ReadySceneJob(const Session& session, const SceneOptions& options, const LaunchOptions& launch);
  ReadySceneJob(const ReadySceneJob&) = delete;
  ReadySceneJob& operator=(const ReadySceneJob&) = delete;

  const std::unique_ptr<frontend::ShaderCache> shaders;
  const std::unique_ptr<pipeline::StructureCache> structures;
  exec::PrintLog prints;
  pipeline::RenderJob job;
};

// Returns what run.json says of the job, and the title of its summary.
report::RunInfo describe_scene(const Session& session, const SceneOptions& options,
                               const LaunchOptions& launch, const pipeline::RenderJob& job);
report::StructureInfo structure_info(const pipeline::StructureCounts& made);
std::string title_of(const pipeline::RenderJob& job, const SceneOptions& options,
                     const LaunchOptions& launch);

// Throws UserError for options that do not go together, or have values that no scene takes. It loads nothing.
void check_scene_run(SceneOptions options, const LaunchOptions& launch);
// Runs what check_scene_run() has let pass.
Exit run_scene(const Session& session, SceneOptions options, const LaunchOptions& launch);

}  // namespace glint::app
