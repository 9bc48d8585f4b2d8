// Reading of GPU configurations.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/config.h"

#include <fmt/format.h>

#include <cstdio>

#include "base/config.h"
#include "base/diagnostics.h"
#include "memsys/peak.h"

namespace glint::app {
namespace {

// What is impossible is the machine's to refuse, when one is built.
void print_warnings(const pipeline::GpuParams& params) {
  Diagnostics diagnostics;
  mem::check(params.memory, diagnostics);
  if (diagnostics.has_errors()) return;
  mem::warn(params.memory, params.cores, params.clock_mhz, diagnostics, "memory.");
  for (const std::string& message : diagnostics.messages()) fmt::print(stderr, "{}\n", message);
}

}  // namespace

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
  print_warnings(params);
  return params;
}

}  // namespace glint::app
