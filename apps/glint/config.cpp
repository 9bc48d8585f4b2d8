// Reading of GPU configurations.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/config.h"

#include "base/config.h"
#include "base/diagnostics.h"

namespace glint::app {

pipeline::GpuParams read_config(const Resources& resources, const std::string& name_or_path,
                                const std::vector<std::string>& settings) {
  Config config;
  config.add_file(resources.config_path(name_or_path));
  for (const std::string& setting : settings) config.add_setting(setting);
  Diagnostics diagnostics;
  ConfigTable root = config.root(diagnostics);
  pipeline::GpuParams params;
  read_params(root, params);
  diagnostics.throw_if_errors();
  return params;
}

}  // namespace glint::app
