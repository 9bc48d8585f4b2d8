// Declares `glint export WORKLOAD`, which writes a frame as files for other Vulkan programs.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <memory>
#include <string>

#include "apps/glint/options/config.h"
#include "apps/glint/options/output.h"
#include "apps/glint/options/shader_options.h"
#include "apps/glint/run/frame_files.h"
#include "apps/glint/run/scene.h"
#include "apps/glint/session.h"

namespace glint::app {
namespace {

struct ExportOptions {
  SceneOptions scene;
  ShaderOptions shaders;
  std::string out;
  uint32_t threads = 1;
};

std::string upper(std::string text) {
  for (char& c : text) c = c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
  return text;
}

Exit export_frame(const Session& session, ExportOptions options) {
  check_scene(options.scene);
  const scenes::RenderParams frame = options.scene.frame.frame();
  if (frame.frame_width)
    throw UserError({}, "a window of a frame cannot be exported",
                    "leave --crop out: Vulkan launches have no first pixel");
  pipeline::RenderJob job = frame_job(session, options.scene, options.threads);
  job.glsl = glsl_options(options.shaders, nullptr);
  const std::string name = fmt::format("{}_{}", job.scene.name, upper(options.scene.shader));
  const std::string folder = options.out.empty() ? "out/frame-" + name : options.out;
  const FrameFiles written = write_frame(job, name, folder);
  print_output("{} files, {:.1f} MB: {}/frame.json\n", written.files, double(written.bytes) / 1e6, folder);
  return Exit::Ok;
}

}  // namespace

void add_export(Command app, Session& session) {
  auto options = std::make_shared<ExportOptions>();
  Command command =
      app.add_subcommand("export", "Write a workload as files that a Vulkan program can draw on any GPU");
  command
      .add_option(
          "SCENE", options->scene.scene,
          "What to write: a scene ('glint list scenes' names them), a workload (SHIP_SH) or a scene of "
          "your own (FILE.obj, FILE.gltf, FILE.glb)")
      .required();
  command
      .add_option("--shader", options->scene.shader,
                  "Shader set to use: pt, sh or ao; 'glint list shaders' explains them")
      .capture_default_str();
  command
      .add_option("--shader-dir", options->scene.shader_dir,
                  "Folder whose shaders are used instead of the workload's built-in ones")
      .type_name("DIR");
  add_frame_options(command, options->scene.frame);
  add_assets_option(command, options->scene.assets);
  command.add_flag("--instancing", options->scene.instancing,
                   "Let models that are affine copies of another one share its structure and vertices");
  add_source_options(command, options->shaders);
  command.add_option("--threads", options->threads, "Threads that load the scene; 0: one for each processor")
      .in_range(0u, 256u)
      .capture_default_str();
  command.add_option("--out", options->out, "Folder to write to (default: out/frame-WORKLOAD)")
      .type_name("DIR");
  command.callback([&session, options, command] {
    options->scene.shader_given = command.count("--shader") > 0;
    session.action = [&session, options] { return export_frame(session, *options); };
  });
}

}  // namespace glint::app
