// Adds the options for include folders, macros and contraction, and opens the caches of shaders, structures
// and scenes.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/shader_options.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>

#include "base/diagnostics.h"
#include "base/host_threads.h"

namespace glint::app {
namespace {

namespace fs = std::filesystem;

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

std::string cache_folder(const std::string& kind) {
  if (const std::string folder = variable("GLINT_CACHE"); !folder.empty()) return folder + "/" + kind;
  // By the XDG Base Directory Specification, relative paths there are invalid and ignored.
  if (const std::string folder = variable("XDG_CACHE_HOME"); folder.starts_with('/'))
    return folder + "/glint/" + kind;
  if (const std::string home = variable("HOME"); !home.empty()) return home + "/.cache/glint/" + kind;
  return {};  // The cache is only in memory.
}

// Checks the name of a macro, so that glslang does not blame a line that the user never wrote.
void check_macro(const std::string& name) {
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; };
  const auto is_part = [&](char c) { return is_letter(c) || std::isdigit(static_cast<unsigned char>(c)); };
  // A macro with parameters is "name(a,b)"; glslang checks the parameters.
  const std::string identifier = name.substr(0, name.find('('));
  if (identifier.empty() || !is_letter(identifier[0]) ||
      !std::all_of(identifier.begin(), identifier.end(), is_part))
    throw UserError({}, fmt::format("--define has no macro's name in '{}'", name),
                    "expected -D NAME or -D NAME=VALUE");
}

// Returns an identifier that changes with the executable, because another one may compile differently.
std::string build_id() {
  std::error_code failed;
  const fs::path self = fs::read_symlink("/proc/self/exe", failed);
  const uint64_t bytes = failed ? 0 : fs::file_size(self, failed);
  const auto time = failed ? fs::file_time_type() : fs::last_write_time(self, failed);
  return failed ? std::string()
                : fmt::format("{} {} {}", GLINT_VERSION, bytes, time.time_since_epoch().count());
}

}  // namespace

void add_source_options(Command command, ShaderOptions& options) {
  command.add_option("-I,--include", options.include_dirs, "Folder to search for #include files")
      .type_name("DIR")
      .allow_extra_args(false);
  command.add_option("-D,--define", options.defines, "Macro to define")
      .type_name("NAME[=VALUE]")
      .allow_extra_args(false);
}

void add_shader_options(Command command, ShaderOptions& options) {
  add_source_options(command, options);
  command.add_flag("--contract", options.contract,
                   "Compile a * b + c of GLSL to one fma, as drivers do, except where it is `precise`");
  command.add_flag(
      "--no-cache", options.no_cache,
      "Compile shaders, make scenes and build structures again, and keep none of them in the caches");
}

frontend::GlslOptions glsl_options(const ShaderOptions& options, frontend::ShaderCache* cache) {
  frontend::GlslOptions glsl;
  glsl.cache = cache;
  glsl.include_dirs = options.include_dirs;
  for (const std::string& define : options.defines) {
    const size_t equals = define.find('=');
    const bool has_value = equals != std::string::npos;
    check_macro(define.substr(0, equals));
    glsl.defines.emplace_back(define.substr(0, equals), has_value ? define.substr(equals + 1) : "1");
  }
  return glsl;
}

std::unique_ptr<frontend::ShaderCache> open_shader_cache(const ShaderOptions& options) {
  if (options.no_cache) return nullptr;
  const std::string build = build_id();
  // When the executable cannot be told from another one, what it compiled stays in memory.
  return std::make_unique<frontend::ShaderCache>(
      frontend::ShaderCache::Options{build.empty() ? "" : cache_folder("shaders"), build});
}

std::unique_ptr<pipeline::StructureCache> open_structure_cache(const ShaderOptions& options,
                                                               const std::vector<Plugin>& plugins) {
  const std::string build = build_id();
  if (options.no_cache || build.empty()) return nullptr;
  return std::make_unique<pipeline::StructureCache>(
      pipeline::StructureCache::Options{cache_folder("structures"), build + identity_of(plugins)});
}

std::unique_ptr<scenes::SceneStore> open_scene_store(const ShaderOptions& options, uint32_t threads) {
  const std::string build = build_id();
  if (options.no_cache || build.empty()) return nullptr;
  scenes::SceneStore::Options store{cache_folder("scenes"), build};
  store.threads = host_threads(threads);
  return std::make_unique<scenes::SceneStore>(store);
}

}  // namespace glint::app
