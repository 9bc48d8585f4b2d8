// Parses TOML by toml++.
// SPDX-License-Identifier: Apache-2.0
#include "base/toml_text.h"

#include <optional>

#include "base/diagnostics.h"
#include "base/regular_file.h"

namespace glint {

toml::table toml_of_text(const std::string& text, const std::string& name) {
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw UserError({name, int(at.line), int(at.column)}, std::string(error.description()));
  }
}

toml::table toml_of_file(const std::string& path) {
  const std::optional<std::string> text = read_regular_file(path);
  if (!text)
    throw UserError({path}, "cannot read the file",
                    "name a TOML file that exists and that you may read; folders and pipes are none");
  return toml_of_text(*text, path);
}

}  // namespace glint
