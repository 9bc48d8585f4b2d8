// Declares `glint init FILE.toml SHADER...`, which writes a description of a pipeline, or the launch file of
// a kernel, that runs as it is.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <optional>

#include "apps/glint/options/command_line.h"
#include "apps/glint/options/output.h"
#include "apps/glint/options/shader_options.h"
#include "apps/glint/run/launch_defaults.h"
#include "apps/glint/session.h"
#include "pipeline/description/defaults.h"
#include "setup/resources.h"

namespace glint::app {
namespace {

struct InitOptions {
  std::string file;
  std::vector<std::string> shaders;
  bool force = false;
  ShaderOptions compile;
};

// Returns the launch file of a kernel. Where there is no such PTX file it writes a kernel to begin with.
std::string launch_of(const InitOptions& options, const std::string& folder) {
  if (options.shaders.size() > 1)
    throw UserError({}, "a launch file is of one PTX file",
                    "name that file alone; a pipeline consists of shaders in GLSL or SPIR-V");
  const std::string& file = options.shaders[0];
  std::error_code failed;
  if (!std::filesystem::exists(file, failed)) {
    std::string out = default_launch(starter_kernel(), file, folder);
    write_output(file, std::string(starter_kernel()));
    fmt::print(stderr, "note: there was no '{}', so a kernel to begin with was written there\n", file);
    return out;
  }
  const std::optional<std::string> text = setup::text_of_file(file);
  if (!text) throw UserError({}, fmt::format("cannot read '{}'", file));
  return default_launch(*text, file, folder);
}

Exit init(const InitOptions& options) {
  std::error_code failed;
  if (!options.force && std::filesystem::exists(options.file, failed))
    throw UserError({options.file, 0, 0}, "the file exists already", "--force overwrites it");
  const std::string folder = std::filesystem::path(options.file).parent_path().string();
  const bool is_kernel =
      std::any_of(options.shaders.begin(), options.shaders.end(),
                  [](const std::string& file) { return std::filesystem::path(file).extension() == ".ptx"; });
  write_output(options.file, is_kernel
                                 ? launch_of(options, folder)
                                 : pipeline::default_description(options.shaders, folder,
                                                                 glsl_options(options.compile, nullptr)));
  return Exit::Ok;
}

}  // namespace

void add_init(Command app, Session& session) {
  auto options = std::make_shared<InitOptions>();
  Command command = app.add_subcommand(
      "init", "Write a pipeline file from what shaders declare, or the launch file of a PTX kernel");
  command.add_option("FILE", options->file, "TOML file to write").required();
  command
      .add_option(
          "SHADER", options->shaders,
          "One ray generation or compute shader, and the shaders that it calls; or one PTX file, which is "
          "written when it does not exist")
      .required();
  add_source_options(command, options->compile);
  command.add_flag("--force", options->force, "Overwrite a file that exists");
  command.callback([&session, options] { session.action = [options] { return init(*options); }; });
}

}  // namespace glint::app
