// Reads the presets of the repository, for tests.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "base/config.h"
#include "base/diagnostics.h"
#include "pipeline/params.h"

namespace glint::test {

// Returns the parameters of a preset in configs/.
inline pipeline::GpuParams preset(const std::string& name) {
  Config config;
  config.add_file(std::string(GLINT_SOURCE_DIR) + "/configs/" + name + ".toml");
  Diagnostics diagnostics;
  ConfigTable root = config.root(diagnostics);
  pipeline::GpuParams params;
  read_params(root, params);
  diagnostics.throw_if_errors();
  return params;
}

}  // namespace glint::test
