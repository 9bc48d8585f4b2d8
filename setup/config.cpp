// Reads GPU configurations.
// SPDX-License-Identifier: Apache-2.0
#include "setup/config.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

#include "base/config.h"
#include "base/diagnostics.h"
#include "memsys/peak.h"
#include "pipeline/check_params.h"
#include "report/files/config_file.h"
#include "setup/oracles.h"

namespace glint::setup {
namespace fs = std::filesystem;
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

// Returns the name that a file gives to its key `base`, with its place; "" when the file has no such key.
std::string base_of(const std::string& path, SourceLocation& where) {
  Config file;
  file.add_file(path);
  Diagnostics diagnostics;
  ConfigTable root = file.root(diagnostics);
  where = root.where("base");
  const std::string base = root.take_string("base", "");
  diagnostics.throw_if_errors();
  if (base.empty() && root.has("base"))
    throw UserError(where, "'base' is empty", "name a preset, or a file beside this one");
  return base;
}

// Returns the path of a base. The name of a preset wins; other names are files, as seen from the file that
// has the key.
std::string base_path(const Resources& resources, const std::string& base, const std::string& from,
                      const SourceLocation& where) {
  const fs::path beside = fs::path(from).parent_path() / base;
  std::error_code error;
  const std::vector<std::string> presets = resources.config_names();
  const bool is_preset = std::find(presets.begin(), presets.end(), base) != presets.end();
  if (!is_preset && fs::is_regular_file(beside, error)) return beside.string();
  if (is_preset) return resources.config_path(base);
  const std::string guess = nearest(base, presets);
  throw UserError(where,
                  fmt::format("the base '{}' is neither a preset ({}) nor the file '{}'", base,
                              fmt::join(presets, ", "), beside.string()),
                  guess.empty() ? "" : fmt::format("did you mean '{}'?", guess));
}

// Returns the file and its bases. The lowest base comes first, because later files win.
std::vector<std::string> with_bases(const Resources& resources, const std::string& name_or_path) {
  std::vector<std::string> chain{resources.config_path(name_or_path)};
  for (SourceLocation where;;) {
    const std::string base = base_of(chain.back(), where);
    if (base.empty()) break;
    chain.push_back(base_path(resources, base, chain.back(), where));
    std::error_code error;
    const auto same = [&](const std::string& one) { return fs::equivalent(one, chain.back(), error); };
    if (std::any_of(chain.begin(), chain.end() - 1, same))
      throw UserError(where, fmt::format("the bases go in a circle: {}", fmt::join(chain, " -> ")),
                      "one of these files must stand without a 'base'");
  }
  std::reverse(chain.begin(), chain.end());
  return chain;
}

}  // namespace

pipeline::GpuParams read_preset(const Resources& resources, const std::string& name_or_path,
                                const std::vector<std::string>& settings) {
  Config config;
  for (const std::string& path : with_bases(resources, name_or_path)) config.add_file(path);
  for (const std::string& setting : without_oracles(resources, settings)) config.add_setting(setting);
  Diagnostics diagnostics;
  ConfigTable root = config.root(diagnostics);
  if (root.has("base") && root.where("base").file.rfind("--set", 0) == 0)
    diagnostics.error(root.where("base"), "a base stands in a file", "--config chooses the machine");
  root.take_string("base", "");
  pipeline::GpuParams params;
  read_params(root, params);
  diagnostics.throw_if_errors();
  refuse_impossible(config, params);
  return params;
}

std::vector<std::string> oddities_of(const pipeline::GpuParams& params) {
  Diagnostics diagnostics;
  mem::warn(params.memory, params.cores, params.clock_mhz, diagnostics, "memory.");
  return diagnostics.messages();
}

std::vector<std::string> names_of_whole_presets(const Resources& resources) {
  std::vector<std::string> names = resources.config_names();
  std::erase_if(names, [&](const std::string& name) {
    SourceLocation ignored;
    try {
      return !base_of(resources.config_path(name), ignored).empty();
    } catch (const Error&) {
      return false;  // Whoever reads the preset says what is wrong.
    }
  });
  return names;
}

uint64_t config_hash(const pipeline::GpuParams& params) {
  return report::fnv1a(report::config_key_values(describe_params(params)));
}

}  // namespace glint::setup
