// Reads GPU configurations.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/config.h"

#include <cstdio>
#include <fmt/format.h>

#include "base/config.h"
#include "base/diagnostics.h"
#include "memsys/peak.h"
#include "pipeline/check_params.h"
#include "report/files/config_file.h"

namespace glint::app {
namespace {

// Returns where the user has set a key, or with `table_too` where its table is. Returns an empty place for a
// key with its default.
SourceLocation place_of(const Config& config, std::string key, bool table_too) {
  Diagnostics ignored;
  ConfigTable table = config.root(ignored);
  for (size_t dot; (dot = key.find('.')) != std::string::npos; key = key.substr(dot + 1))
    table = table.take_table(key.substr(0, dot));
  return table_too || table.has(key) ? table.where(key) : SourceLocation{};
}

// Returns the place of the first quoted key in the message that the user has set. With `table_too`, a key
// also counts when something in its table is set.
SourceLocation place_of_quoted(const Config& config, const std::string& message, bool table_too) {
  for (size_t open = message.find('\''); open != std::string::npos;) {
    const size_t close = message.find('\'', open + 1);
    if (close == std::string::npos) break;
    const SourceLocation place = place_of(config, message.substr(open + 1, close - open - 1), table_too);
    if (!place.file.empty()) return place;
    open = message.find('\'', close + 1);
  }
  return {};
}

// Refuses what is impossible. Each message has the place of a key that causes it.
void refuse_impossible(const Config& config, const pipeline::GpuParams& params) {
  Diagnostics diagnostics;
  pipeline::check(params, diagnostics);
  if (!diagnostics.has_errors()) return;
  std::string out;
  for (const std::string& message : diagnostics.messages()) {
    std::string place = place_of_quoted(config, message, false).to_string();
    if (place.empty()) place = place_of_quoted(config, message, true).to_string();
    out += (out.empty() ? "" : "\n") + (place.empty() ? "" : place + ": ") + message;
  }
  throw UserError(out);
}

void print_warnings(const pipeline::GpuParams& params) {
  Diagnostics diagnostics;
  mem::warn(params.memory, params.cores, params.clock_mhz, diagnostics, "memory.");
  for (const std::string& message : diagnostics.messages()) fmt::print(stderr, "{}\n", message);
}

pipeline::GpuParams read_quietly(const Resources& resources, const std::string& name_or_path,
                                 const std::vector<std::string>& settings) {
  Config config;
  config.add_file(resources.config_path(name_or_path));
  for (const std::string& setting : settings) config.add_setting(setting);
  Diagnostics diagnostics;
  ConfigTable root = config.root(diagnostics);
  pipeline::GpuParams params;
  read_params(root, params);
  diagnostics.throw_if_errors();
  refuse_impossible(config, params);
  return params;
}

}  // namespace

pipeline::GpuParams read_preset(const Resources& resources, const std::string& name_or_path) {
  return read_quietly(resources, name_or_path, {});
}

uint64_t config_hash(const pipeline::GpuParams& params) {
  return report::fnv1a(report::config_key_values(describe_params(params)));
}

pipeline::GpuParams read_config(const Resources& resources, const std::string& name_or_path,
                                const std::vector<std::string>& settings) {
  const pipeline::GpuParams params = read_quietly(resources, name_or_path, settings);
  print_warnings(params);
  return params;
}

}  // namespace glint::app
