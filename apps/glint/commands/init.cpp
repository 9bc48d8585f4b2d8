// Declares `glint init FILE.toml SHADER...`, which writes a description of a pipeline that runs as it is.
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fmt/format.h>
#include <memory>

#include "apps/glint/options/command_line.h"
#include "apps/glint/options/resources.h"
#include "apps/glint/options/shader_options.h"
#include "apps/glint/session.h"
#include "pipeline/description/defaults.h"

namespace glint::app {
namespace {

struct InitOptions {
  std::string file;
  std::vector<std::string> shaders;
  bool force = false;
  ShaderOptions compile;
};

Exit init(const InitOptions& options) {
  std::error_code failed;
  if (!options.force && std::filesystem::exists(options.file, failed))
    throw UserError({options.file, 0, 0}, "the file exists already", "--force overwrites it");
  const std::string folder = std::filesystem::path(options.file).parent_path().string();
  write_output(options.file, pipeline::default_description(options.shaders, folder,
                                                           glsl_options(options.compile, nullptr)));
  return Exit::Ok;
}

}  // namespace

void add_init(Command app, Session& session) {
  auto options = std::make_shared<InitOptions>();
  Command command = app.add_subcommand("init", "Write a pipeline file from what shaders declare");
  command.add_option("FILE", options->file, "TOML file to write").required();
  command
      .add_option("SHADER", options->shaders,
                  "One ray generation or compute shader, and the shaders that it calls")
      .required();
  add_source_options(command, options->compile);
  command.add_flag("--force", options->force, "Overwrite a file that exists");
  command.callback([&session, options] { session.action = [options] { return init(*options); }; });
}

}  // namespace glint::app
