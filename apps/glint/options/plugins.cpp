// Loads shared libraries after their stamp has been compared.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/plugins.h"

#include <dlfcn.h>
#include <filesystem>
#include <fmt/format.h>
#include <string_view>

#include "base/diagnostics.h"
#include "base/file_store.h"
#include "base/plugin_stamp.h"
#include "base/registry.h"
#include "setup/resources.h"

namespace glint::app {
namespace {

// The stamp is looked for in the bytes of the file and not by name, because loading a library runs its code:
// a plugin of another Glint would register objects of another layout.
void check_stamp(const std::string& path, std::string_view bytes) {
  const size_t begin = bytes.find(kPluginStampPrefix);
  if (begin == std::string_view::npos)
    throw UserError(
        {path}, "the file is not a plugin of Glint",
        "build it with glint_add_plugin() of find_package(glint); docs/howto/policy.md shows how");
  const std::string_view stamp = bytes.substr(begin, bytes.find('\0', begin) - begin);
  if (const std::string_view ours = glint_plugin_stamp; stamp != ours)
    throw UserError(
        {path},
        fmt::format("the plugin was built against other headers ({}) than this program ({})",
                    stamp.substr(kPluginStampPrefix.size()), ours.substr(kPluginStampPrefix.size())),
        "install this Glint and build the plugin again");
}

Plugin load(const std::string& file) {
  const std::string path = std::filesystem::absolute(file).lexically_normal().string();
  const std::string bytes = setup::read_file(path);
  check_stamp(path, bytes);
  const size_t before = all_policies().size();
  const bool is_loaded_already = ::dlopen(path.c_str(), RTLD_NOW | RTLD_NOLOAD) != nullptr;
  if (!::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL))
    throw UserError({path}, fmt::format("the plugin cannot be loaded: {}", ::dlerror()));
  if (!registered_twice().empty())
    throw UserError(
        {path},
        fmt::format("the plugin registers a policy whose name is taken ({})", registered_twice().front()),
        "change its kName");
  if (!is_loaded_already && all_policies().size() == before)
    throw UserError({path}, "the plugin registers no policy",
                    "a file of it needs `const Register<Interface, Policy> registered;`");
  return {path, content_hash(bytes)};
}

}  // namespace

void add_plugin_option(Command app, std::vector<std::string>& files) {
  app.options_reach_subcommands();
  app.add_option("--plugin", files, "Shared library whose policies are loaded; several are separated by ':'")
      .type_name("FILE")
      .envname("GLINT_PLUGINS")
      .delimiter(':')
      .allow_extra_args(false);
}

std::vector<Plugin> load_plugins(const std::vector<std::string>& files) {
  std::vector<Plugin> out;
  for (const std::string& file : files)
    if (!file.empty()) out.push_back(load(file));
  return out;
}

std::string identity_of(const std::vector<Plugin>& plugins) {
  std::string out;
  for (const Plugin& plugin : plugins) out += fmt::format(" {}:{:016x}", plugin.path, plugin.hash);
  return out;
}

}  // namespace glint::app
